. "$(dirname "$0")/lib.sh"

patience=5
[ "$SANITIZE" != ON ] || patience=60

# interrupted SIGNAL ARGUMENTS...: a rendering of minutes ends by the signal in seconds and leaves no file.
interrupted() {
    local signal=$1 pid status started
    shift
    "$VKWHITTED" render "$figure" -o a.png -o b.exr --stats c.json "$@" >out 2>err &
    pid=$!
    sleep 2
    kill -0 $pid 2>/dev/null || fail 'it has ended by itself'
    kill -s "$signal" $pid
    for ((tenths = 0; tenths < patience * 10; ++tenths)); do
        kill -0 $pid 2>/dev/null || break
        sleep 0.1
    done
    ! kill -KILL $pid 2>/dev/null || fail "it has not heard $signal in $patience s"
    wait $pid
    status=$?
    [ $status -eq $((128 + $(kill -l "$signal"))) ] || fail "exit status $status after $signal"
    only_files
}

set -m # or else the shell has background jobs ignore SIGINT
sigint_on_device() { interrupted INT --size 4000x4000 --samples 256; }
sigint_on_cpu() { interrupted INT --size 4000x4000 --samples 64 --backend cpu; }
sigterm() { interrupted TERM --size 4000x4000 --samples 256; }

"$1"
