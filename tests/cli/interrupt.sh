. "$(dirname "$0")/lib.sh"

RANDOM=13
patience=10 # tenths of a second, on a busy machine
[ "$SANITIZE" != ON ] || patience=300
large='--size 4000x4000 --samples 64'
set -m # or else the shell has background jobs ignore SIGINT
# The others may be ignored where the tests are run.
start() {
    env --default-signal=TERM,HUP,PIPE "$VKWHITTED" "$@" >out 2>err &
    pid=$!
    while [ "$(<"/proc/$pid/comm")" = "$(<"/proc/$$/comm")" ]; do :; done # lest a signal meets the shell's child
}

# ends_by SIGNAL ARGUMENTS...: the signal ends the program soon, by that signal, and nothing is left behind.
ends_by() {
    local signal=$1 status
    shift
    kill -s "$signal" $pid 2>/dev/null
    for ((tenths = 0; tenths < patience; ++tenths)); do
        kill -0 $pid 2>/dev/null || break
        sleep 0.1
    done
    ! kill -KILL $pid 2>/dev/null || fail "it has not heard $signal: $*"
    wait $pid 2>/dev/null
    status=$?
    [ $status -eq $((128 + $(kill -l "$signal"))) ] || [ $status -eq 0 ] || fail "exit status $status after $signal: $*"
    [ -z "$(find . -name '.*.*.*.*')" ] || fail "temporary files after $signal: $*"
}

# at_random_moments MILLISECONDS ARGUMENTS...: of the first so many.
at_random_moments() {
    local most=$1 signals=(INT TERM HUP PIPE) times=8 delay
    shift
    [ "$SANITIZE" != ON ] || times=4
    for ((i = 0; i < times; ++i)); do
        printf -v delay '0.%03d' $((RANDOM % most))
        start "$@"
        sleep "$delay"
        ends_by "${signals[i % 4]}" "$@"
    done
}

render_on_device() { at_random_moments 400 render $large "$figure" -o a.png -o b.exr --stats c.json; }
render_on_cpu() { at_random_moments 200 render $large --backend cpu "$figure" -o a.png -o b.exr --stats c.json; }
writing() { at_random_moments 150 render --backend cpu --max-bounces 0 --size 500x400 "$SOURCE_DIR/scenes/figure_2a.yaml" -o a.png -o b.exr -o c.pfm; }
check() { at_random_moments 400 check $large "$figure" --json a.json --heatmap b.png; }
bench() { at_random_moments 400 bench --size 4000x4000 "$figure" --json a.json --csv a.csv --report a.html; }
pixel() { at_random_moments 600 pixel --max-bounces 64 --samples 4096 "$SOURCE_DIR/scenes/hard/diamond.yaml" 120 80 --json a.json; }
watch() { at_random_moments 600 watch --size 60x40 "$figure" -o a.png -o b.exr; }
packing() {
    { printf 'camera: { position: [0, 0, 0], look_at: [0, 0, 1] }\nimage: { width: 4, height: 4 }\n'
      printf 'materials: [{ name: M, type: transparent }]\nobjects:\n'
      for ((i = 0; i < 15000; ++i)); do
          printf -- '  - { name: S%d, type: sphere, center: [%d, 0, 9], radius: 5000, material: M }\n' $i $i
      done; } >s.yaml
    at_random_moments 600 render --backend cpu s.yaml -o a.png
}

# Where nobody writes to a pipe: the scene, a shader's include.
fifo() {
    mkfifo s.yaml
    for command in 'render --backend cpu s.yaml -o a.png' 'check s.yaml' 'bench s.yaml' 'pixel s.yaml 1 1'; do
        start $command
        sleep 0.3
        kill -0 $pid 2>/dev/null || fail "$command has ended by itself"
        ends_by TERM "$command"
    done
    expect 2 "$VKWHITTED" watch s.yaml -o a.png
    said 's.yaml: error: is not a regular file'
    cp -r "$SOURCE_DIR/shaders" shaders
    rm shaders/escape.glsl && mkfifo shaders/escape.glsl
    start watch "$figure" --shaders shaders -o a.png
    sleep 1
    kill -0 $pid 2>/dev/null || fail 'watch has ended by itself'
    ends_by TERM watch
    rm shaders/whitted.comp && mkfifo shaders/whitted.comp
    expect 2 "$VKWHITTED" watch "$figure" --shaders shaders -o a.png
    said 'shaders/whitted.comp: is not a regular file'
}

# What was ignored at the start is.
ignored() {
    (trap '' HUP; exec "$VKWHITTED" render --backend cpu --size 600x400 "$figure" -o a.pfm) >out 2>err &
    pid=$!
    sleep 0.2
    kill -HUP $pid
    wait $pid || fail 'it has heard a signal that is ignored'
    [ -s a.pfm ] || fail 'no picture'
}

"$1"
