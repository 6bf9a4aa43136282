# The page and the chart that bench --report writes, from a document with all that is awkward in it. The
# environment names WRITE_REPORT, too.
. "$(dirname "$0")/lib.sh"
document=$SOURCE_DIR/tests/report/document.json

write() { expect 0 "$WRITE_REPORT" "$document" page.html chart.svg; }

well_formed() {
    write
    expect 0 xmllint --noout --nonet page.html chart.svg
    not_said . err
    not_said '<script|onmouse|javascript|url\(http|src="[^d]|@import' page.html
    not_said '<script|onmouse|javascript' chart.svg
    said '<dd>&lt;script&gt;alert\(1\)&lt;/script&gt;</dd>' page.html
    said '<h2>scenes/&quot;Œuvre&quot; \\\{\}\^_@%s`id` &amp; &lt;b&gt;.yaml</h2>' page.html
    said '>no error \\\{\}\^_@%s`id` &amp; &lt;b&gt; &quot;.</text>' chart.svg
    # Ten of eleven settings are measured.
    [ "$(grep -c '<circle.*<title>' chart.svg)" -eq 10 ] || fail "not 10 points in the chart"
    [ "$(grep -c '<tr id="s0-p' page.html)" -eq 11 ] || fail "not 11 rows in the table"
}

same_bytes_whatever_the_user_likes() {
    write
    mkdir first
    mv page.html chart.svg first
    echo 'set terminal dumb; set title "mine"; exit status 1' >.gnuplot
    expect 0 env HOME="$PWD" GNUTERM=dumb LC_ALL=C.UTF-8 "$WRITE_REPORT" "$document" page.html chart.svg
    cmp page.html first/page.html && cmp chart.svg first/chart.svg || fail "other bytes"
}

# without_charts PATTERN: with what lies in ./bin instead of gnuplot nothing is written.
without_charts() {
    echo old >page.html
    expect 3 env PATH="$PWD/bin" "$WRITE_REPORT" "$document" page.html chart.svg
    said "^vkwhitted: error: gnuplot.*$1"
    [ "$(wc -l <err)" -eq 1 ] || fail "not one line"
    [ "$(cat page.html)" = old ] || fail "page.html is no longer what it was"
    only_files bin page.html
}

no_gnuplot() {
    mkdir bin
    without_charts 'No such file.*package gnuplot-nox'
}

gnuplot_fails() {
    mkdir bin
    printf '#!/bin/sh\nexit 7\n' >bin/gnuplot
    chmod +x bin/gnuplot
    without_charts 'exit status 7'
    printf '#!/bin/sh\necho "<svg></svg>"\n' >bin/gnuplot
    without_charts 'no SVG'
}

browser() {
    command -v chromium >/dev/null || skip "no chromium"
    write
    cp "$SOURCE_DIR/tests/report/measure.html" .
    HOME=$PWD timeout 100 chromium --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage \
        --disable-background-networking --no-first-run --user-data-dir="$PWD/profile" \
        --allow-file-access-from-files --enable-logging=stderr --window-size=1500,1000 \
        --dump-dom "file://$PWD/measure.html" >out 2>err || fail "chromium ended with $?"
    not_said 'WRONG' out
    not_said ':CONSOLE' err
    # 10 points against error, 5 and 3 of convergence.
    said '^390: 3 charts, 18 points' out
    said '^1400: 3 charts, 18 points' out
}

"$1"
