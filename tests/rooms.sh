#!/usr/bin/env bash
# rooms.sh SOURCE_FOLDER: every #include in host/ carries its room and follows an arrow of this table, and no
# headers include each other in a circle.
set -euo pipefail
cd "$1"

# room: the rooms that it may use
table='
cli: bench pixel watch check tracer scene image vulkan base
bench: check tracer scene image vulkan base
pixel: tracer scene image vulkan base
watch: check tracer scene image vulkan base
check: tracer scene image base
tracer: scene image vulkan base
scene: base
image: base
vulkan: base
base:
'
outside=' reference.h reference_events.h packed_scene.h scene_layout.h ' # of cpu_reference/ and shaders/

failures=0
fail() {
    echo "$1" >&2
    failures=$((failures + 1))
}

edges=$(mktemp)
trap 'rm -f "$edges"' EXIT
while IFS=: read -r file line; do
    from=${file#host/}
    room=${from%%/*}
    header=${line#*\"}
    header=${header%\"*}
    if [[ ! -f host/$header ]]; then # made by the build, or from outside
        [[ -f $(dirname "$file")/$header ]] && fail "$file: \"$header\": an include carries its room"
        [[ $header == */* ]] && fail "$file: \"$header\": there is no such file in host/"
        if [[ -f cpu_reference/$header || -f shaders/$header ]] && [[ $outside != *" $header "* ]]; then
            fail "$file: \"$header\" is not for the host"
        fi
        continue
    fi
    used=${header%%/*}
    allowed=$(sed -n "s/^$room://p" <<<"$table")
    [[ $used == "$room" || " $allowed " == *" $used "* ]] || fail "$file: room $room may not use $used (\"$header\")"
    grep -q "^$room:" <<<"$table" || fail "$file: no room $room in the table"
    [[ $from == "$header" ]] || echo "$from $header" >>"$edges"
    # a header's source counts with it: what it needs, its users need
    [[ $from == *.c && -f host/${from%.c}.h && ${from%.c}.h != "$header" ]] && echo "${from%.c}.h $header" >>"$edges"
done < <(grep -rn '^#include "' host --include='*.[ch]' | sed -E 's/^([^:]+):[0-9]+:/\1:/')
[[ -s $edges ]] || fail 'no includes found'
if ! circles=$(tsort "$edges" 2>&1 >/dev/null); then
    fail "a circle of includes:
$circles"
fi
[[ $failures == 0 ]]
