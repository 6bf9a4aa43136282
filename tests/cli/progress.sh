. "$(dirname "$0")/lib.sh"

command -v script >/dev/null || skip 'no script(1) of util-linux'
long="render $figure --size 1200x800 --samples 8 --backend cpu --threads 1"

on_a_terminal() {
    script -qec "$VKWHITTED $long" typescript >/dev/null </dev/null || fail 'exit status'
    grep -aqE 'rendering \[#* *\] +[0-9]+ %' typescript || fail 'no progress bar'
    last=$(tr '\r' '\n' <typescript | grep -a 'ms on cpu')
    [ -n "$last" ] || fail 'the bar was not wiped before the message'
    script -qec "$VKWHITTED render $small $figure --backend cpu" typescript >/dev/null </dev/null
    ! grep -aq 'rendering \[' typescript || fail 'a bar for short work'
}

# A tile of many samples, and one in which pixels take long: the bar is there before the tile is.
inside_tiles() {
    for options in "$figure --size 40x30 --samples 16384" "$SOURCE_DIR/scenes/hard/diamond.yaml --size 60x40 --samples 8 --max-bounces 64"; do
        script -qec "$VKWHITTED render $options" typescript >/dev/null </dev/null || fail 'exit status'
        tr '\r' '\n' <typescript | grep -aoE 'rendering \[#* *\] +[0-9]+ %' | grep -aoE '[0-9]+ %' | sort -u >percents
        [ "$(grep -vc -e '^0 %' -e '^100 %' percents)" -ge 2 ] || fail "the bar stands still: $(tr '\n' ' ' <percents)"
    done
}

# Said where there is no terminal, too.
minutes() {
    local work="render $figure --size 4000x4000 --samples 1024" backend
    for backend in vulkan cpu; do
        "$VKWHITTED" $work --backend $backend 2>err &
        for ((i = 0; i < 300; ++i)); do
            ! grep -q takes err || break
            sleep 0.1
        done
        kill %% && wait %%
        said '^vkwhitted: rendering takes (about|more than) [0-9]+ (minutes|hours)$'
    done
}

not_elsewhere() {
    expect 0 "$VKWHITTED" $long
    not_said 'rendering'
    [ "$(wc -l <err)" -eq 1 ] || fail 'not one line'
}

quiet() {
    expect 0 "$VKWHITTED" $long -q
    [ ! -s err ] && [ ! -s out ] || fail 'not quiet'
    script -qec "$VKWHITTED $long -q" typescript >/dev/null </dev/null || fail 'exit status'
    ! grep -aq 'rendering' typescript || fail 'a bar'
}

"$1"
