#!/bin/bash
# Has call after call of a program fail: walk.sh LIBRARY CALL MOST PROGRAM ARGUMENT...
#
# In a new folder the program is run once as it is, then once for each of its calls, or for MOST of them, spread evenly.
# Each time it must end with status 3 and an error message, or with 0 and the same files as the first time; no file may be
# a part of one or a temporary one, and what the program allocated must be freed. A crash in a library of the list below
# counts as passed. LIBRARY is fail_calls.c, and CALL one of its words.
set -u
shopt -s nullglob dotglob
library=$1 call=$2 most=$3
shift 3
program=("$@")

# What crashes when it has no memory: libfyaml in fy_parse_input_append() and others; the Vulkan loader and lavapipe,
# with LLVM.
known_crash='crash in (libfyaml|libvulkan|libLLVM|libgallium|libstdc\+\+)'

folder=$(mktemp -d) || exit 1
trap 'cd /; rm -rf "$folder"' EXIT
mkdir "$folder/good" "$folder/files" && cd "$folder/files" || exit 1

# run N: with the Nth call failing; sets the status, the number of calls, and of allocations that were not freed.
run() {
    : >../counts
    LD_PRELOAD=$library FAIL=$call:$1 FAIL_COUNT=$folder/counts "${program[@]}" >/dev/null 2>../err
    status=$?
    read -r calls left <../counts || calls=0 left=0 # it did not get so far
    said=$(<../err)
}

# A JSON text has times in it, which differ, and an end.
is_whole() {
    case $1 in
    *.json) [ -e "../good/$1" ] && [ "$(tail -c 2 "$1")" = '}' ] ;;
    *) cmp -s "$1" "../good/$1" ;;
    esac
}

# Sets `problem` to what is not as it must be; '' if there is nothing.
find_problem() {
    local files=(*) good=(../good/*) file
    problem=
    if [ $status -gt 128 ]; then
        [[ $said =~ $known_crash ]] || problem=crash
        return
    fi
    [[ $said != *'libgomp: Out of memory'* ]] || return # it ends the process itself
    case $status in
    0) [ ${#files[@]} -eq ${#good[@]} ] || problem='files are missing' ;;
    3) [[ $said == *'error: '* ]] || problem='no message'
       [ "$call" != vulkan ] || [[ $said == *': VK_ERROR_'* ]] || problem='no result' ;;
    *) problem='another status' ;;
    esac
    [ "$left" -eq 0 ] || problem='memory is not freed'
    for file in "${files[@]}"; do is_whole "$file" || problem="$file is not what it should be"; done
}

fail() {
    printf '%s: %s, status %d, %d allocations left, said:\n%s\n' "$1" "$2" $status "$left" "$said" >&2
    exit 1
}

run -1
[ $status -eq 0 ] && [ "$left" -eq 0 ] && [ "$calls" -gt 0 ] || fail 'as it is' "$calls calls"
files=(*)
[ ${#files[@]} -eq 0 ] || mv "${files[@]}" ../good
total=$calls
runs=$((total < most ? total : most))
for ((i = 0; i < runs; ++i)); do
    run $((i * total / runs))
    find_problem
    [ -z "$problem" ] || fail "$call:$((i * total / runs))" "$problem"
    files=(*)
    [ ${#files[@]} -eq 0 ] || rm -- "${files[@]}"
done
echo "$call: $runs of $total calls failed"
