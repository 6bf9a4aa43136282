. "$(dirname "$0")/lib.sh"

tiny='--quick --size 12x8'
matte=$SOURCE_DIR/scenes/figure_2a.yaml

# In seconds only on a machine that has time: nothing here depends on it.
files() {
    expect 0 "$VKWHITTED" bench $tiny "$figure" "$matte" --json a.json --csv a.csv
    [ ! -s err ] || fail 'standard error'
    only_files a.json a.csv
    [ "$(json a.json scenes)" -eq 2 ] || fail 'not two scenes'
    [ "$(json a.json command)" = "vkwhitted bench $tiny --json a.json --csv a.csv $figure $matte" ] || fail command
    [ -n "$(json a.json machine device)" ] && [ "$(json a.json machine cores)" -ge 1 ] || fail 'no machine'
    points=0
    for scene in 0 1; do
        here=$(json a.json scenes $scene points)
        [ "$(json a.json scenes $scene recommendations)" -eq 4 ] || fail recommendations
        for ((i = 0; i < here; ++i)); do
            [ "$(json a.json scenes $scene points $i rays primary)" -ge 96 ] || fail "rays of point $i"
            [ "$(json a.json scenes $scene points $i runs)" -ge 3 ] || fail "runs of point $i"
        done
        points=$((points + here))
    done
    ! grep -q 'max-error\|max-bounces\|light-samples' <(sed -n '/figure_2a/,$p' out) ||
        fail 'knobs that matte has no use for'
    [ "$(grep -c -- '--max-error' out)" -ge 5 ] && [ "$(grep -c -- '--max-bounces [0-9]* ' out)" -ge 6 ] || fail knobs
    [ "$(grep -c '^\*' out)" -ge 4 ] || fail 'no Pareto front'
    [ "$(grep -c 'fastest settings' out)" -eq 2 ] || fail 'no recommendation'
    # RFC 4180: a line of names, a line a point, each of as many fields; no comma is quoted here.
    [ "$(wc -l <a.csv)" -eq $((points + 1)) ] || fail 'lines of a.csv'
    [ "$(grep -c $'\r$' a.csv)" -eq $((points + 1)) ] || fail 'line ends of a.csv'
    sed 's/"[^"]*"/x/g' a.csv | awk -F, '{ if (NF != 30) exit 1 }' || fail 'fields of a.csv'
}

without_device() {
    export VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent
    expect 3 "$VKWHITTED" bench $tiny "$matte" --json a.json
    only_files
    cat >old.json <<END
{ "machine": { "processor": "another" }, "scenes": [ { "scene": "$matte", "width": 12, "height": 8, "truth": "another",
  "points": [ { "options": "--backend cpu", "time_ms": 1e-60, "runs": 9 } ] } ] }
END
    expect 0 "$VKWHITTED" bench $tiny "$matte" --backend cpu --json a.json --compare old.json
    said 'another machine: processor .*, was another' out
    said 'compared 1 settings: 0 became worse, 0 better beyond noise' out
    [ "$(json a.json scenes 0 points 0 backend)" = cpu ] || fail 'not on the CPU'
    ! "$JSON_GET" a.json machine device >device 2>&1 || fail 'a device'
    rm device
}

# The script that draws the README's charts from the CSV file.
chart() {
    command -v gnuplot >/dev/null || skip 'no gnuplot'
    expect 0 "$VKWHITTED" bench $tiny "$figure" --csv a.csv
    expect 0 gnuplot -c "$SOURCE_DIR/host/bench/chart.gp" a.csv a.svg
    [ ! -s err ] || fail 'warnings'
    only_files a.csv a.svg
    for text in 'time, ms' 'Pareto front' 'open: fast' 'samples a pixel' "$figure"; do
        grep -Fq ">$text<" a.svg || fail "no $text in the chart"
    done
}

bad_comparison() {
    expect 2 "$VKWHITTED" bench $tiny "$matte" --compare no.json --json a.json
    said '^vkwhitted: error: .*no.json'
    echo '{"scenes": [' >bad.json
    refused 2 'bad.json:[0-9]+:[0-9]+: ' bench $tiny "$matte" --compare bad.json
    echo '{"scenes": []}' >bad.json
    refused 2 'bad.json: expected a file that bench --json wrote' bench $tiny "$matte" --compare bad.json
    only_files bad.json
}

"$1"
