. "$(dirname "$0")/lib.sh"

patience=20 # seconds for anything to show
[ "$SANITIZE" != ON ] || patience=100
turn='^vkwhitted: (picture [0-9]+: (same pipeline|pipeline)|compile failed|scene refused|rendering failed)'

turns() { grep -Ecs -- "$turn" err; }
# eventually COMMAND...
eventually() {
    local end=$((SECONDS + patience))
    until "$@"; do
        [ $SECONDS -lt $end ] || fail "never: $*"
        sleep 0.02
    done
}
has_turns() { [ "$(turns)" -ge "$1" ] 2>/dev/null; }
last_turn() { grep -E -- "$turn" err | tail -1; }

# start ARGUMENTS...: watches s.yaml with the shaders in shaders/, 60x40, until the end of the test.
start() {
    cp "$figure" s.yaml
    cp -r "$SOURCE_DIR/shaders" shaders
    "$VKWHITTED" watch s.yaml $small --shaders shaders -o a.pfm "$@" >out 2>err &
    watcher=$!
    trap 'kill -KILL $watcher 2>/dev/null; cd /; chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
    eventually has_turns 1
}

# turn PATTERN COMMAND...: the command's changes bring about a turn, the last of them like this.
turn() {
    local pattern=$1 before
    shift
    before=$(turns)
    "$@" || fail "$*"
    eventually has_turns $((before + 1))
    eventually ends_like "$pattern"
}
ends_like() { last_turn | grep -Eq -- "$1"; }

finish() {
    kill -INT $watcher
    wait $watcher
    status=$?
    [ $status -eq 130 ] || fail "exit status $status after Ctrl-C"
}

# The picture is that of the files as they are.
picture_is_rendered_scene() {
    "$VKWHITTED" render -q s.yaml $small -o expected.pfm || fail 'render'
    cmp a.pfm expected.pfm || fail 'not the picture that render makes'
}

edit() { sed "$1" "$2" >edited && ! cmp -s edited "$2" && mv edited "$2"; }
set -m # or else the shell has background jobs ignore SIGINT

scene_edits_keep_the_pipeline() {
    start
    picture_is_rendered_scene
    for fov in 50 51 52; do
        turn 'same pipeline' edit "s/fov_y: [0-9]*/fov_y: $fov/" s.yaml
        picture_is_rendered_scene
    done
    turn 'same pipeline' edit 's/power: [0-9]*/power: 77/' s.yaml
    turn 'pipeline rebuilt in [0-9.]+ ms' edit 's/type: transparent.*}/type: mirror }/' s.yaml
    picture_is_rendered_scene
    turn 'same pipeline' edit 's/width: [0-9]*/width: 300/' s.yaml
    picture_is_rendered_scene
    finish
    [ "$(grep -c rebuilt err)" -eq 1 ] || fail 'another pipeline was built'
    only_files a.pfm expected.pfm s.yaml shaders
}

shader_edits() {
    local formula='(matte.a + matte.b \* sin_tan)'
    start
    cp a.pfm first.pfm
    turn 'same pipeline' sh -c 'echo "// a comment" >>shaders/shade.glsl'
    cmp a.pfm first.pfm || fail 'a comment changed the picture'
    turn 'pipeline rebuilt' edit "s/$formula/(real(2) * matte.a)/" shaders/shade.glsl
    ! cmp -s a.pfm first.pfm || fail 'the picture has not changed'
    turn 'pipeline rebuilt' cp "$SOURCE_DIR/shaders/shade.glsl" shaders/
    cmp a.pfm first.pfm || fail 'the picture is not what it was'
    finish
}

broken_and_repaired() {
    start
    cp a.pfm first.pfm
    turn 'compile failed after .* ms; picture 1 stays' edit '7s/$/\nfloat wrong = nothing;/' shaders/dielectric.glsl
    said "^shaders/dielectric.glsl:8: error: 'nothing' : undeclared identifier$"
    turn 'scene refused; picture 1 stays' edit 's/radius: [0-9.]*/radius: -1/' s.yaml
    said '^s.yaml:[0-9]+:[0-9]+: error: .*radius must be > 0, is -1$'
    turn 'compile failed; picture 1 stays' cp "$figure" s.yaml
    cmp a.pfm first.pfm || fail 'the last good picture has gone'
    turn 'picture 2: same pipeline' cp "$SOURCE_DIR/shaders/dielectric.glsl" shaders/
    cmp a.pfm first.pfm || fail 'the picture is not what it was'
    turn 'compile failed' edit 's/binding = 8/binding = 12/' shaders/pixel.glsl
    said '^shaders/whitted.comp: error: set 0, binding 12: the program provides'
    turn 'picture 3: same pipeline' cp "$SOURCE_DIR/shaders/pixel.glsl" shaders/
    finish
}

# Broken from the start; files that are not there are a mistake of the command line.
broken_at_the_start() {
    cp -r "$SOURCE_DIR/shaders" shaders
    echo 'camera: 1' >s.yaml
    refused 2 'nowhere/whitted.comp: No such file' watch s.yaml --shaders nowhere -o a.pfm
    expect 2 "$VKWHITTED" watch nothing.yaml -o a.pfm
    said '^nothing.yaml: error: No such file'
    "$VKWHITTED" watch s.yaml $small --shaders shaders -o a.pfm >out 2>err &
    watcher=$!
    eventually has_turns 1
    ends_like 'scene refused; there is no picture yet' || fail 'the first turn'
    [ ! -e a.pfm ] || fail 'a picture of nothing'
    turn 'picture 1: pipeline built' cp "$figure" s.yaml
    picture_is_rendered_scene
    finish
}

ways_of_saving() {
    start
    turn 'scene refused' mv s.yaml away.yaml
    said '^s.yaml: error: No such file'
    turn 'same pipeline' mv away.yaml s.yaml
    turn 'same pipeline' sh -c 'sed s/fov_y:.*[0-9]/fov_y:\ 55/ s.yaml >t; cat t >s.yaml; rm t'
    sed 's/power: [0-9]*/power: 44/' s.yaml >real.yaml
    turn 'same pipeline' ln -sf real.yaml s.yaml
    turn 'same pipeline' edit 's/power: [0-9]*/power: 33/' real.yaml
    picture_is_rendered_scene
    mkdir later && cp -r shaders later/first && mv shaders later/second && ln -s later/first shaders
    turn 'compile failed' sh -c 'echo broken >>later/first/scene.glsl'
    turn 'same pipeline' ln -sfn later/second shaders
    mkdir shaders/part && mv shaders/tally.glsl shaders/part/
    edit 's,"tally.glsl","part/tally.glsl",' shaders/whitted.comp
    echo broken >>shaders/part/tally.glsl
    eventually grep -Eq '^shaders/part/tally.glsl:[0-9]+: error: ' err
    turn 'same pipeline' cp "$SOURCE_DIR/shaders/tally.glsl" shaders/part/
    finish
}

# What is missing, or broken outside the folder, is mended.
missing_includes() {
    local of=$SOURCE_DIR/shaders
    start
    mkdir shaders/later
    turn 'compile failed' edit 's,"tally.glsl","later/tally.glsl",' shaders/whitted.comp
    said '^shaders/whitted.comp:[0-9]+: error: cannot include later/tally.glsl$'
    turn 'same pipeline' cp "$of/tally.glsl" shaders/later/
    turn 'compile failed' edit 's,"later/tally.glsl","../tally.part",' shaders/whitted.comp
    turn 'compile failed' sh -c 'echo broken >tally.part'
    said '^shaders/../tally.part:[0-9]+: error: '
    turn 'same pipeline' cp "$of/tally.glsl" tally.part
    turn 'same pipeline' sh -c 'echo "// a comment" >>tally.part'
    picture_is_rendered_scene
    finish
}

# A file with spheres is followed from when the scene names it, whole or not, there or not.
spheres_from_a_file() {
    local line='  - { name: Flake, type: spheres, file: rows.npy, material: GreyMatte }'
    start
    "$BINARY_DIR/make_spheres" cloud 20 >one.npy
    "$BINARY_DIR/make_spheres" cloud 21 | sed 's/(21, 4)/(20, 4)/' | head -c $((128 + 16 * 20)) >two.npy
    printf '\0\0\0\100' | dd of=two.npy bs=1 seek=128 conv=notrunc status=none # x of row 0
    turn 'scene refused; picture 1 stays' edit "s/^objects:/&\n$line/" s.yaml
    said 'rows.npy: No such file'
    turn 'picture 2: ' cp one.npy rows.npy
    picture_is_rendered_scene
    turn 'picture 3: same pipeline' cp two.npy rows.npy
    picture_is_rendered_scene
    turn 'picture 4: same pipeline' sh -c '(head -c 300 one.npy; sleep 0.4; tail -c +301 one.npy) >rows.npy'
    picture_is_rendered_scene
    turn 'scene refused; picture 4 stays' sh -c 'head -c 300 one.npy >rows.npy'
    said 'rows.npy: is truncated'
    turn 'picture 5: ' cp two.npy rows.npy
    picture_is_rendered_scene
    turn 'picture 6: ' edit '/rows.npy/d' s.yaml
    before=$(turns)
    cp one.npy rows.npy
    sleep 0.5
    [ "$(turns)" -eq "$before" ] || fail 'a file that no scene names is followed'
    finish
    [ "$(grep -c truncated err)" -eq 1 ] || fail 'half a file was read'
}

# The camera goes from one sphere of glass into another: the pipeline stays, and so does what finds the spheres, but not
# which of them hold the camera.
camera_among_many_spheres() {
    start
    "$BINARY_DIR/make_spheres" cloud 300 >rows.npy
    turn 'picture 2: pipeline' edit 's/^objects:/&\n  - { name: Flake, type: spheres, file: rows.npy, material: Glass }/' s.yaml
    picture_is_rendered_scene
    turn 'same pipeline' sh -c 'cat rows.npy >moved.npy; printf "\0\0\200\100" | dd of=moved.npy bs=1 seek=140 conv=notrunc status=none; mv moved.npy rows.npy'
    picture_is_rendered_scene
    for row in 3 4 21; do # within the room
        set -- $(od -An -v -tf4 -w16 -j$((128 + 16 * row)) -N16 rows.npy)
        turn 'same pipeline' edit "s/camera: { position: [^]]*]/camera: { position: [$1, $2, $3]/" s.yaml
        picture_is_rendered_scene
    done
    finish
}

# 200 in a row, in all ways: the last one counts, and each picture is one of a whole file.
quick_saves() {
    local i
    start
    for i in {1..200}; do
        sed "s/power: [0-9]*/power: $((100 + i))/" s.yaml >new.yaml
        case $((i % 3)) in
        0) mv new.yaml s.yaml ;;
        1) cat new.yaml >s.yaml ;;
        2) cp new.yaml real-$((i % 2)).yaml && ln -sf real-$((i % 2)).yaml link && mv link s.yaml ;;
        esac
    done
    "$VKWHITTED" render -q s.yaml $small -o expected.pfm || fail 'render'
    eventually cmp -s a.pfm expected.pfm
    finish
    not_said 'refused|failed'
}

# cpu_ticks: what the program has used.
cpu_ticks() { awk '{ print $14 + $15 }' /proc/$watcher/stat; }

# Waiting takes well under 1 % of a processor.
idle() {
    local before
    start
    sleep 2.5
    before=$(cpu_ticks)
    sleep 5
    [ $(($(cpu_ticks) - before)) -le 4 ] || fail "$(($(cpu_ticks) - before)) of 500 ticks while nothing happens"
    finish
}

# checks_in_the_background FACTOR OPTION...: the picture is found to be right, and wrong with that factor in a formula.
checks_in_the_background() {
    local factor=$1
    shift
    start --check "$@"
    eventually grep -q '^vkwhitted: picture 1: agrees with the reference in all 2400 pixels' err
    turn 'pipeline rebuilt' edit "s/matte.b \* sin_tan)/matte.b * sin_tan * real($factor))/" shaders/shade.glsl
    eventually grep -Eq '^vkwhitted: picture 2: [1-9][0-9]* of 2400 pixels differ from the reference' err
    finish
}
checked_in_the_background() { checks_in_the_background 1.01 --validate; }
# Both sides are in double, and the factor is 1 in float.
checked_in_double() {
    "$VKWHITTED" devices | grep -q 'fp64 *yes' || skip 'no fp64'
    checks_in_the_background 1.0000000001lf --precision double
}

# Whichever call of a turn fails, or loses the device: that is said, and the next turn's picture is right.
failing_calls() {
    local code number lost=0
    export VK_ADD_LAYER_PATH=$LAYER VK_INSTANCE_LAYERS=VK_LAYER_VKWHITTED_pretend PRETEND_FAIL=$PWD/plan
    start
    for number in {1..1000}; do
        code=$((number % 2 ? -2 : -4))
        echo "$number $code" >new && mv new plan
        turn . edit 's/type: transparent.*}/type: mirror }/' s.yaml
        [ ! -e plan ] || break
        last_turn | grep -q 'rendering failed; picture [0-9]* stays' || fail "call $number"
        [ "$(grep -Ec 'error: vk[A-Za-z]+.*: VK_ERROR_(DEVICE_LOST|OUT_OF_DEVICE_MEMORY)' err)" = "$number" ] || fail "call $number"
        [ $code = -2 ] || eventually has_reopened $((++lost))
        turn 'pipeline rebuilt' cp "$figure" s.yaml
        picture_is_rendered_scene
    done
    [ "$number" -gt 20 ] || fail "only $number calls in a turn"
    finish
}
has_reopened() { [ "$(grep -c '^vkwhitted: the device was lost, and opened again' err)" -ge "$1" ]; }

"$1"
