#!/usr/bin/env bash
# rooms.sh SOURCE_FOLDER: every source of host/ lies in a room, every #include in it carries its room and follows an
# arrow of this table, and no files include each other in a circle.
set -euo pipefail
cd "$1"

# room: the rooms that it may use; `reference` stands for the headers below
table='
cli: bench pixel watch check tracer scene image vulkan base
bench: tracer scene image vulkan base reference
pixel: tracer scene image vulkan base reference
watch: check tracer scene image vulkan base
check: tracer scene image base reference
tracer: scene image vulkan base reference
scene: base reference
image: base
vulkan: base
base:
'
reference=' reference.h sphere_tree.h packed_scene.h scene_layout.h ' # what cpu_reference/ and shaders/ offer

declare -A allowed
while IFS=: read -r room used; do
    [[ -z $room ]] || allowed[$room]=" $room $used "
done <<<"$table"

failures=0
fail() {
    echo "$1" >&2
    failures=$((failures + 1))
}

allow() { # allow FILE ROOM USED
    [[ ${allowed[$2]-} == *" $3 "* ]] || fail "$1: room $2 may not use $3"
}

edges=$(mktemp)
trap 'rm -f "$edges"' EXIT
while IFS= read -r file; do
    [[ $file =~ ^host/([^/]+)/[^/]+$ && ${allowed[${BASH_REMATCH[1]}]-} ]] || fail "$file lies in no room of the table"
done < <(find host -name '*.[ch]')
while IFS=: read -r file line; do
    from=${file#host/}
    room=${from%%/*}
    header=${line#*[\"<]}
    header=${header%%[\">]*}
    if [[ $reference == *" $header "* ]]; then
        allow "$file" "$room" reference
    elif [[ -f host/$header ]]; then
        allow "$file" "$room" "${header%%/*}"
        [[ $from == "$header" ]] || echo "$from $header" >>"$edges"
        # a header's source counts with it: what it needs, its users need
        [[ $from == *.c && -f host/${from%.c}.h && ${from%.c}.h != "$header" ]] && echo "${from%.c}.h $header" >>"$edges"
    elif [[ -f ${file%/*}/$header ]]; then
        fail "$file: \"$header\": an include carries its room"
    elif [[ -f cpu_reference/$header || -f shaders/$header ]]; then
        fail "$file: \"$header\" is not for the host"
    elif [[ $line == *\"* && $header == */* ]]; then
        fail "$file: \"$header\": there is no such file in host/"
    fi # else made by the build, or from outside
done < <(grep -rnE '^[[:space:]]*#[[:space:]]*include' host --include='*.[ch]' | sed -E 's/^([^:]+):[0-9]+:/\1:/')
[[ -s $edges ]] || fail 'no includes found'
if ! circles=$(tsort "$edges" 2>&1 >/dev/null); then
    fail "a circle of includes:
$circles"
fi
[[ $failures == 0 ]]
