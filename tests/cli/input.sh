. "$(dirname "$0")/lib.sh"

missing_scene() {
    for command in render check; do
        expect 2 "$VKWHITTED" $command no/such.yaml
        said 'no/such.yaml: .*(No such file|cannot)'
        [ "$(wc -l <err)" -eq 1 ] || fail 'not one line'
    done
}

# A scene of the program's by its name, but for a file of that name.
scene_by_name() {
    expect 0 "$VKWHITTED" check $small figure_4 hard/bubble figure_2a.yaml
    said "^$SOURCE_DIR/scenes/hard/bubble.yaml: 0 of 2400 pixels differ" out
    [ "$(wc -l <out)" -eq 3 ] || fail 'not three scenes'
    refused 2 "figure_5: no such scene; expected a scene file, or one of the program's: figure_2a, .*, sphereflake \(all: $SOURCE_DIR/scenes\)$" check figure_4 figure_5
    refused 2 "expected a scene file, or one of the program's: figure_2a, " render
    expect 2 "$VKWHITTED" check ./figure_4
    echo 'camera: 5' >figure_4
    expect 2 "$VKWHITTED" render figure_4
    said '^figure_4:1:1: error'
}

folder_as_scene() {
    expect 2 "$VKWHITTED" render .
    said 'error: '
    expect 2 "$VKWHITTED" render /dev/null
    said '/dev/null.*error: '
}

bad_scene() {
    sed 's/radius: 1.5, material: Glass/radius: -1.5, material: Glass/' "$figure" >bad.yaml
    expect 2 "$VKWHITTED" render bad.yaml -o a.png
    said '^bad.yaml:[0-9]+:[0-9]+: error: .*radius'
    line=$(sed -nE 's/^bad.yaml:([0-9]+):.*/\1/p' err | head -1)
    column=$(sed -nE 's/^bad.yaml:[0-9]+:([0-9]+):.*/\1/p' err | head -1)
    [ "$(sed -n "${line}p" bad.yaml | cut -c "$column"-"$((column + 3))")" = -1.5 ] || fail 'wrong place'
    sed -n 2p err | grep -qF 'radius: -1.5' || fail 'the line itself is not shown'
    sed -n 3p err | grep -qE '^ *\^' || fail 'no caret'
    only_files bad.yaml
}

bad_scene_among_good_ones() {
    echo 'camera: 5' >bad.yaml
    expect 2 "$VKWHITTED" check $small "$figure" bad.yaml "$SOURCE_DIR/scenes/figure_2a.yaml" --json result.json
    [ "$(grep -c ' 0 of 2400 pixels differ' out)" -eq 2 ] || fail 'the others are not checked'
    said '^bad.yaml:'
    [ "$(json result.json scenes)" = 2 ] || fail 'not two results in the JSON file'
}

scene_that_is_warned_of() {
    for command in render 'check --json result.json'; do
        expect 0 "$VKWHITTED" $command --size 30x20 "$SOURCE_DIR/tests/scenes/overlapping_glass.yaml"
        [ "$(grep -c '^vkwhitted: warning: ' err)" = 1 ] || fail "not one warning from $command"
        said 'overlapping_glass.yaml:[0-9:]+ transparent bodies "Ball1" and "Ball2" overlap \(and 2 other pairs\)'
    done
}

scene_beyond_float() {
    cat >planet.yaml <<'SCENE'
camera: { position: [0, 6360002, -8], look_at: [0, 6360001, 0], fov_y: 40 }
image: { width: 60, height: 40 }
materials: [{ name: Soil, type: matte, color: [0.5, 0.4, 0.3] }]
objects:
  - { name: Ball, type: sphere, center: [0, 6360001, 0], radius: 1, material: Soil }
  - { name: Planet, type: sphere, center: [0, 0, 0], radius: 6360000, material: Soil }
lights: [{ type: point, position: [4, 6360008, -4], power: 200 }]
SCENE
    for command in 'render --backend cpu' check; do
        expect 0 "$VKWHITTED" $command planet.yaml
        said 'warning: planet.yaml:6:5: sphere "Planet": radius 6.36e\+06 m, seen from .* off by 1 % or more in [0-9]+ % .*--precision double'
        [ "$(grep -c warning err)" = 1 ] || fail "not one warning from $command"
    done
    expect 0 "$VKWHITTED" render --backend cpu --precision double planet.yaml
    not_said warning
    for scene in "$SOURCE_DIR"/scenes/*.yaml "$SOURCE_DIR"/scenes/hard/*.yaml "$SOURCE_DIR/tests/scenes/earth.yaml"; do
        expect 0 "$VKWHITTED" render --backend cpu --size 24x16 --max-bounces 3 --light-samples 4 "$scene"
        not_said 'pixels looked at'
    done
}

"$1"
