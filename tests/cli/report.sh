# The page that bench --report writes, from a document with all that is awkward in it.
. "$(dirname "$0")/lib.sh"
document=$SOURCE_DIR/tests/report/document.json

write() { expect 0 "$BINARY_DIR/tests/write_report" "$document" page.html; }

# The document is in the page as it is, and cannot break out of its element.
document_in_page() {
    write
    not_said . err
    [ "$(grep -c '<script' page.html)" -eq 2 ] || fail 'not two scripts'
    [ "$(grep -c '</script' page.html)" -eq 2 ] || fail 'not two ends of scripts'
    [ "$(grep -c '<!--' page.html)" -eq 1 ] || fail 'not one comment'
    not_said 'onmouse|javascript:|(src|href)="(http|//)|@import|url\(' page.html
    [ "$(LC_ALL=C grep -c $'\xe2\x80\xa8' page.html)" -eq 0 ] || fail 'a line separator'
    said "Content-Security-Policy" page.html
    sed -n 's|^<script type="application/json" id="bench">\(.*\)</script>$|\1|p' page.html >page.json
    ! grep -q '<' page.json || fail 'markup in the document'
    for keys in 'machine processor' 'machine device' 'command' 'scenes 0 scene' 'scenes 0 points 2 label' \
        'scenes 0 points 2 options' 'scenes 0 points 3 time_ms'; do
        [ "$(json page.json $keys)" = "$(json "$document" $keys)" ] || fail "$keys: $(json page.json $keys)"
    done
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
    # 10 points against error, 5 and 3 of convergence; 3 + 11 rows of tables.
    said '^390: 3 charts, 18 points, 14 rows' out
    said '^1400: 3 charts, 18 points, 14 rows' out
}

"$1"
