#!/usr/bin/env bash
# slurm.sh PROGRAM SOURCE_FOLDER: a cluster of this machine alone renders 16 tiles with scenes/tiles.sbatch; one is
# killed in the middle. The joined picture has the bits of one that was rendered whole, and what is there stays.
set -euo pipefail
export LC_ALL=C program=$1
source=$2
folder=$(mktemp -d)
scene=$source/scenes/figure_4.yaml
options=(--size 300x200 --backend cpu --threads 1)

daemons=()
stop() {
    local daemon
    for daemon in "${daemons[@]}"; do # the last one first: it needs the others
        kill "$daemon" 2>/dev/null && wait "$daemon" || true
    done
    rm -rf "$folder"
}
trap stop EXIT

fail() {
    echo "slurm.sh: $*" >&2
    tail -n 20 "$folder"/*.log "$folder"/*.out >&2 2>/dev/null || true
    exit 1
}

# wait_for SECONDS COMMAND...
wait_for() {
    local i tenths=$((10 * $1))
    shift
    for ((i = 0; i < tenths; ++i)); do
        ! "$@" || return 0
        sleep 0.1
    done
    fail "this did not come true: $*"
}

start_daemon() {
    "/usr/sbin/$1" "${@:2}" >"$folder/$1.log" 2>&1 &
    daemons=($! "${daemons[@]}")
}

start() {
    mkdir "$folder/state" "$folder/spool"
    chmod 755 "$folder"
    local port=$((20000 + $$ % 20000))
    sed -e "s|FOLDER|$folder|" -e "s|HOST|$(hostname -s)|" -e "s|USER|$(id -un)|" -e "s|CONTROL_PORT|$port|" \
        -e "s|NODE_PORT|$((port + 1))|" "$source/tests/slurm.conf.in" >"$folder/slurm.conf"
    export SLURM_CONF=$folder/slurm.conf
    [[ $(slurmctld -V) =~ \ 2[0-3]\. ]] || echo CgroupPlugin=disabled >"$folder/cgroup.conf" # there may be no cgroups
    head -c 1024 /dev/urandom >"$folder/munge.key"
    chmod 600 "$folder/munge.key"
    start_daemon munged --foreground --force --socket="$folder/munge.socket" --key-file="$folder/munge.key" \
        --pid-file="$folder/munged.pid" --seed-file="$folder/munged.seed"
    wait_for 10 test -S "$folder/munge.socket"
    start_daemon slurmctld -D -c
    start_daemon slurmd -D
    wait_for 30 idle
}
idle() { [[ $(sinfo --noheader --format=%T 2>/dev/null) == idle ]]; }
done_with() { [[ -z $(squeue --noheader --jobs "$1" 2>/dev/null) ]]; }

# The rendering of tile 7 is killed, once.
cat >"$folder/vkwhitted" <<'END'
#!/bin/sh
case "$*" in
*"--tile 7/16"*) mkdir "${0%/*}/killed" 2>/dev/null && exec timeout --signal=KILL 0.3 "$program" "$@" --samples 65536 ;;
esac
echo "$*" >>"${0%/*}/rendered"
exec "$program" "$@"
END
chmod +x "$folder/vkwhitted"

# Submits the array and a join that depends on it, and waits for both.
run() {
    local array join
    array=$(sbatch --parsable --output="$folder/%a.out" "$source/scenes/tiles.sbatch" "$scene" "$folder/tiles" "${options[@]}")
    join=$(sbatch --parsable --output="$folder/join.out" --dependency="afterok:$array" \
        --wrap "'$program' join '$folder'/tiles/tile_*.exr -o '$folder/joined.pfm'")
    wait_for 90 done_with "$join"
    [[ -s $folder/joined.pfm ]] || fail 'there is no joined picture'
}

start
export VKWHITTED=$folder/vkwhitted
run
"$program" render -q "$scene" "${options[@]}" -o "$folder/whole.pfm"
cmp "$folder/whole.pfm" "$folder/joined.pfm" || fail 'the joined picture is another'
[[ -d $folder/killed ]] || fail 'no tile was killed'
grep -q 'tile 7 ended with status 137; it is queued again' "$folder/7.out" || fail 'tile 7 does not tell that it was killed'
[[ $(sort -u "$folder/rendered" | wc -l) == 16 ]] || fail 'not 16 tiles were rendered'

# Again, with one tile missing: it alone is rendered.
rm "$folder/tiles/tile_3.exr" "$folder/joined.pfm" "$folder/rendered"
run
cmp "$folder/whole.pfm" "$folder/joined.pfm" || fail 'the picture joined again is another'
[[ $(<"$folder/rendered") == *'--tile 3/16 '* && $(wc -l <"$folder/rendered") == 1 ]] || fail 'finished tiles were rendered again'
