. "$(dirname "$0")/lib.sh"

quick='--backend cpu --threads 1 --size 8x8'

# An output that is an input or another output is refused, under any name, and nothing is changed.
eaten_inputs() {
    mkdir folder
    cp "$figure" s.yaml
    cp "$SOURCE_DIR/scenes/sphereflake.npy" flake.npy
    sed 's/sphereflake.npy/flake.npy/' "$SOURCE_DIR/scenes/sphereflake.yaml" >flake.yaml
    ln -s ../s.yaml folder/link.json
    ln s.yaml hard.json
    ln -s flake.npy link.png
    cat s.yaml flake.npy flake.yaml >before
    for json in s.yaml ./s.yaml folder/../s.yaml folder/link.json hard.json; do
        refused 2 '.*is to be written' render $quick s.yaml --stats $json
        refused 2 '.*is to be written' check --backend cpu --against double s.yaml --json $json
        refused 2 '.*is to be written' bench --backend cpu s.yaml --json $json
        refused 2 '.*is to be written' bench --backend cpu s.yaml --csv $json
        refused 2 '.*is to be written' pixel s.yaml 1 1 --json $json
    done
    echo '{}' >old.json
    refused 2 'old.json: cannot read: is also to be written' bench --backend cpu s.yaml --compare old.json --json old.json
    expect 2 "$VKWHITTED" render $quick flake.yaml -o link.png
    said 'flake.npy: is also to be written'
    refused 2 '.*written already' render $quick s.yaml -o same.png --stats same.png
    refused 2 '.*written already' render $quick s.yaml -o same.png -o ./same.png
    refused 2 '.*written already' render $quick s.yaml -o same.png -o folder/../same.png
    refused 2 '.*written already' check s.yaml --json folder/a.png --heatmap folder//a.png
    cat s.yaml flake.npy flake.yaml | cmp - before || fail 'an input has changed'
    rm -r folder before
    only_files s.yaml flake.npy flake.yaml hard.json link.png old.json
}

closed_streams() {
    "$VKWHITTED" render $quick "$figure" -o a.pfm
    for streams in '<&-' '>&-' '2>&-' '<&- >&-' '<&- >&- 2>&-'; do
        eval '"$VKWHITTED" render -q $quick "$figure" -o b.pfm' "$streams" || fail "render with $streams"
        cmp a.pfm b.pfm || fail "another picture with $streams"
        rm b.pfm
    done
    for output in '>&-' '>/dev/full'; do
        for command in '--version' '--help' "pixel $quick_device $figure 1 1" "check --backend cpu --against double $quick $figure"; do
            eval '"$VKWHITTED" $command 2>err' $output
            [ $? -eq 3 ] || fail "$command $output: not status 3"
            said 'cannot write to standard output: (No space left on device|Bad file descriptor)$'
        done
    done
}
quick_device='--size 8x8'

# One output that cannot be written is no reason to lose the others; an empty list replaces nothing.
results_at_the_end() {
    cp "$SOURCE_DIR/tests/faults/tiny.yaml" s.yaml
    mkdir small
    unshare --mount sh -c 'mount -t tmpfs -o size=64k tmpfs small' 2>/dev/null || skip 'no file systems to be mounted here'
    expect 3 unshare --mount sh -c "mount -t tmpfs -o size=16k tmpfs small
        \"$VKWHITTED\" bench -q --quick --backend cpu s.yaml --report small/r.html --json j.json --csv c.csv
        status=\$?; [ -z \"\$(ls -A small)\" ] || exit 99; exit \$status"
    said '^vkwhitted: error: small/r.html: cannot write: No space left on device$'
    [ "$(wc -l <err)" -eq 1 ] || fail 'not one line'
    [ -s j.json ] && [ -s c.csv ] && [ -s out ] || fail 'results are lost'
    expect 3 unshare --mount sh -c "mount -t tmpfs -o size=4k tmpfs small
        \"$VKWHITTED\" render -q --backend cpu $figure -o small/a.png -o b.png --stats c.json"
    [ -s b.png ] && [ -s c.json ] || fail 'results are lost'
    echo '[1]' >good.json
    expect 2 "$VKWHITTED" check -q --backend cpu --against double $quick no.yaml --json good.json
    [ "$(cat good.json)" = '[1]' ] || fail 'an empty list has replaced a file'
}

limits() {
    [ "$SANITIZE" != ON ] || return 0
    local memory status=3
    for ((memory = 60000; memory < 400000 && status != 0; memory += 4000)); do
        (ulimit -v $memory; "$VKWHITTED" render -q --backend cpu --threads 1 --size 500x500 --samples 1 "$figure" -o a.exr >out 2>err)
        status=$?
        case $status in
        0) ;;
        3) said error ;;
        127) ;; # its libraries need as much
        1) said 'libgomp|error while loading' ;;
        *) fail "status $status with $memory KiB" ;;
        esac
        [ $status -eq 0 ] || only_files
    done
    [ $status -eq 0 ] || fail 'it never has enough memory'
}

# Control characters in names and quoted lines.
escapes() {
    local name=$'\e[31m\x07\x9b1m\xe2\x80\xae\xe2\x81\xa6\xc2\x85\n\x7f' shown='\\x1b\[31m\\x07\\x9b1m\\u202e\\u2066\\u0085\\x0a\\x7f'
    local raw=$'[\x01-\x08\x0b-\x1f\x7f\x9b]|\xe2\x80\xae|\xe2\x81\xa6|\xc2\x85'
    shows() {
        ! grep -aqE "$raw" out err || fail "control characters: $*"
        cat out err | grep -aqE "$1" || fail "no $1"
    }
    expect 2 "$VKWHITTED" render $quick "$name.yaml"
    shows "^$shown.yaml: error: "
    expect 3 "$VKWHITTED" render $quick "$figure" -o "no/$name.png"
    shows "no/$shown.png: "
    expect 2 "$VKWHITTED" render $quick "$figure" --crop "$name"
    shows "$shown"
    expect 2 "$VKWHITTED" "$name"
    shows "$shown"
    sed "s/name: \"*Sphere2\"*/name: \"a\\\\u202eb\\\\u009bc\"/" "$figure" >"$name.yaml"
    grep -q u202e "$name.yaml" || fail 'the name is not in the scene'
    expect 0 "$VKWHITTED" check --backend cpu --against double $quick "$name.yaml"
    shows "yaml: against double"
    expect 0 "$VKWHITTED" pixel --size 60x40 "$name.yaml" 20 23
    shows 'a\\u202eb\\u009bc'
    printf 'camera: \xe2\x80\xae [1\nimage: 2' >bad.yaml
    expect 2 "$VKWHITTED" render $quick bad.yaml
    shows 'camera: \\u202e'
}

# Whatever 16 MiB hold: refused within seconds (2 on a machine that has nothing else to do) and 300 MB.
large_files() {
    [ "$SANITIZE" != ON ] || skip 'sanitizers take more'
    local piece
    for piece in '[' '[],' '1,' $'-\n' $'?\n' $'k: 1\n' "''" '!a ' '*a ' '%' $'%A b\n'; do
        { case $piece in ?,) printf '[' ;; esac
          awk -v piece="$piece" 'BEGIN { for (i = 0; i < 65536 / length(piece); ++i) printf "%s", piece }' >block
          for ((i = 0; i < 256; ++i)); do cat block; done; } | head -c 16777216 >s.yaml
        (ulimit -v 1000000 -t 8; expect 2 "$VKWHITTED" render -q --backend cpu s.yaml) || exit 1
    done
}

"$1"
