. "$(dirname "$0")/lib.sh"

tiny='--quick --size 12x8'
matte=$SOURCE_DIR/scenes/figure_2a.yaml

# In seconds only on a machine that has time: nothing here depends on it.
files() {
    expect 0 "$VKWHITTED" bench $tiny "$figure" "$matte" --json a.json
    [ ! -s err ] || fail 'standard error'
    only_files a.json
    [ "$(json a.json scenes)" -eq 2 ] || fail 'not two scenes'
    [ "$(json a.json command)" = "vkwhitted bench $tiny --json a.json $figure $matte" ] || fail command
    [ -n "$(json a.json machine device)" ] && [ "$(json a.json machine cores)" -ge 1 ] || fail 'no machine'
    for scene in 0 1; do
        here=$(json a.json scenes $scene points)
        [ "$(json a.json scenes $scene recommendations)" -eq 4 ] || fail recommendations
        for ((i = 0; i < here; ++i)); do
            [ "$(json a.json scenes $scene points $i rays primary)" -ge 96 ] || fail "rays of point $i"
            [ "$(json a.json scenes $scene points $i runs)" -ge 3 ] || fail "runs of point $i"
        done
    done
    ! grep -q 'max-error\|max-bounces\|light-samples' <(sed -n '/figure_2a/,$p' out) ||
        fail 'knobs that matte has no use for'
    [ "$(grep -c -- '--max-error' out)" -ge 5 ] && [ "$(grep -c -- '--max-bounces [0-9]* ' out)" -ge 6 ] || fail knobs
    [ "$(grep -c '^\*' out)" -ge 4 ] || fail 'no Pareto front'
    [ "$(grep -c 'fastest settings' out)" -eq 2 ] || fail 'no recommendation'
}

without_device() {
    export VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent
    expect 3 "$VKWHITTED" bench $tiny "$matte" --json a.json
    only_files
    expect 0 "$VKWHITTED" bench $tiny "$matte" --backend cpu --json a.json
    [ "$(json a.json scenes 0 points 0 backend)" = cpu ] || fail 'not on the CPU'
    ! "$JSON_GET" a.json machine device >device 2>&1 || fail 'a device'
    rm device
}

# with_times MS: the bench as if all times of the device had been so.
with_times() {
    awk -v ms="$1" '/"backend"/ { device = /vulkan/ }
        device && /"time_quartiles_ms"/ { quartiles = 2; print; next }
        quartiles-- > 0 { sub(/[0-9.e+-]+/, ms) }
        device { sub(/"time_ms": [0-9.e+-]+/, "\"time_ms\": " ms) }
        { print }' a.json
}

compare() {
    tiny='--quick --size 6x4'
    expect 0 "$VKWHITTED" bench $tiny "$matte" --json a.json
    # so far off that no load of the machine hides it
    with_times 1e60 >slow.json
    # the CPU's own times may be anything beside other tests, so the exit status says nothing of the device's
    "$VKWHITTED" bench $tiny "$matte" --compare slow.json >out 2>err
    [ $? -le 1 ] || fail 'it has not compared'
    said 'figure_2a.yaml: --fast: faster: ' out
    not_said 'figure_2a.yaml: (--fast|as the scene says): SLOWER' out
    with_times 1e-60 >fast.json
    expect 1 "$VKWHITTED" bench $tiny "$matte" --compare fast.json
    said 'figure_2a.yaml: --fast: SLOWER: ' out
    sed 's/"processor": ".*"/"processor": "another"/' fast.json >elsewhere.json
    expect 0 "$VKWHITTED" bench $tiny "$matte" --compare elsewhere.json
    said 'another machine: processor .*, was another' out
    sed -E 's/"rmse": [0-9.e+-]+/"rmse": 1e-30/' elsewhere.json >right.json
    expect 1 "$VKWHITTED" bench $tiny "$matte" --compare right.json
    said 'figure_2a.yaml: as the scene says: LESS ACCURATE, RMSE: ' out
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

options() {
    refused 2 'bench takes no option --samples' bench --samples 4 "$figure"
    refused 2 'bench takes no option --precision' bench --precision double "$figure"
    refused 2 'bench takes no option -o' bench -o a.png "$figure"
    refused 2 'render takes no option --quick' render --quick "$figure"
    refused 2 'check takes no option --compare' check --compare a.json "$figure"
    refused 2 'expected a scene file' bench
    expect 3 "$VKWHITTED" bench $tiny "$figure" --json no/such/folder/a.json
    only_files
}

"$1"
