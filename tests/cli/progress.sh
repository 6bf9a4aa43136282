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
