. "$(dirname "$0")/lib.sh"

break_shader term
broken() { "$VKWHITTED" "$1" --shaders broken/term "${@:2}"; }

agreement() {
    expect 0 "$VKWHITTED" check $small "$figure" "$SOURCE_DIR/scenes/figure_2a.yaml"
    [ "$(grep -cE '^/.*/scenes/figure_..?\.yaml: 0 of 2400 pixels differ, max error 0 @ \(0, 0, r\)$' out)" -eq 2 ] || fail output
    [ ! -s err ] || fail 'standard error'
}

difference() {
    expect 1 broken check $small "$figure"
    said '^/.*/figure_4.yaml: [0-9]+ of 2400 pixels differ, max error [0-9.e-]+ @ \([0-9]+, [0-9]+, [rgb]\)  DIFFERS$' out
    [ "$(wc -l <out)" -eq 1 ] || fail 'not one line'
    count=$(sed -E 's/.*: ([0-9]+) of.*/\1/' out)
    [ "$count" -gt 500 ] || fail "only $count pixels differ"
    expect 0 broken check --allow "$count" $small "$figure"
    said ": $count of 2400 pixels differ" out
    not_said DIFFERS out
    expect 1 broken check --allow $((count - 1)) $small "$figure"
    expect 0 broken check --tolerance 0,1e-3 $small "$figure"
    said ': 0 of 2400 pixels differ, max error [0-9.]+e?-?[0-9]* @' out
    not_said 'max error 0 @' out
    expect 1 broken check --tolerance 0,1e-6 $small "$figure"
    expect 1 broken check --tolerance 0 $small "$figure"
}

heatmap() {
    expect 1 broken check --heatmap broken.png $small "$figure"
    expect 0 "$VKWHITTED" check --heatmap same.png $small "$figure"
    expect 0 "$VKWHITTED" check --heatmap also_same.png $small "$SOURCE_DIR/scenes/figure_2a.yaml"
    cmp same.png also_same.png || fail 'two black pictures differ'
    [ "$(wc -c <broken.png)" -gt $((2 * $(wc -c <same.png))) ] || fail 'the heatmap is as empty as a black one'
    only_files broken.png same.png also_same.png
}

# valid_junit TESTS FAILURES ERRORS: so a.xml says, and it is what readers of JUnit's XML expect.
valid_junit() {
    expect 0 xmllint --noout --relaxng "$SOURCE_DIR/tests/cli/junit.rng" a.xml
    said "tests=\"$1\" failures=\"$2\" errors=\"$3\"" a.xml
}

junit() {
    local odd='a<b>&"'\''.yaml'
    cp "$figure" "$odd"
    cp "$figure" $'b\xff\x01\u20ac.yaml'
    expect 0 "$VKWHITTED" check $small --junit a.xml "$odd" $'b\xff\x01\u20ac.yaml'
    valid_junit 2 0 0
    [ "$(xmllint --xpath 'string(//testcase[1]/@name)' a.xml)" = "$odd" ] || fail 'the name'
    [ "$(xmllint --xpath 'string(//testcase[2]/@name)' a.xml)" = $'b\\xff\\x01\u20ac.yaml' ] || fail 'the name that is not UTF-8'
    expect 2 broken check $small --junit a.xml --heatmap maps/ "$odd" no.yaml
    valid_junit 2 1 1
    [ "$(xmllint --xpath 'string(//failure/@message)' a.xml | tr 0-9 _ | tr -s _)" = \
        "_ pixels differ, the first at (_, _), the largest error _._e-_ at (_, _); heatmap: maps/${odd%.yaml}.png" ] || fail 'the failure'
    [ "$(ls maps)" = "${odd%.yaml}.png" ] || fail 'the heatmap'
    expect 1 broken check $small --against double --junit a.xml --heatmap maps/ "$figure"
    valid_junit 1 1 0
    said 'message="[0-9]+ pixels unexplained, the first at \([0-9]+, [0-9]+\); heatmap: maps/.*-scenes-figure_4.png"' a.xml
}

json_fields() {
    json_is "$figure" result.json scenes 0 scene
    json_is "$1" result.json scenes 0 agrees
    json_is 60 result.json scenes 0 width
    json_is 40 result.json scenes 0 height
    [ -n "$(json result.json device)" ] && [ -n "$(json result.json driver)" ] || fail 'no device'
    for key in x y; do
        value=$(json result.json scenes 0 at $key)
        [ "$value" -ge 0 ] && [ "$value" -lt 60 ] || fail "$key $value"
    done
    json result.json scenes 0 at channel | grep -qx '[rgb]' || fail channel
}

json_file() {
    expect 0 "$VKWHITTED" check --json result.json $small "$figure"
    json_fields true
    json_is 0 result.json scenes 0 differing_pixels
    json_is 0 result.json scenes 0 bit_differing_pixels
    json_is 0 result.json scenes 0 max_error
    expect 1 broken check --json result.json $small "$figure"
    json_fields false
    json_is "$(sed -E 's/.*: ([0-9]+) of.*/\1/' out)" result.json scenes 0 differing_pixels
    awk -v x="$(json result.json scenes 0 max_error)" 'BEGIN { exit !(x > 1e-6 && x < 1e-2) }' || fail max_error
    expect 0 broken check --tolerance 1 --json result.json $small "$figure"
    json_fields true
    json_is 0 result.json scenes 0 differing_pixels
    [ "$(json result.json scenes 0 bit_differing_pixels)" -gt 500 ] || fail bit_differing_pixels
    only_files result.json
}

# A formula that is wrong by 1e-4 is found out behind a lens, although deep in the ray tree of every pixel some decision is
# close.
judged_behind_a_lens() {
    lens=$SOURCE_DIR/scenes/hard/lens.yaml
    sed 's/max_bounces: 10/max_bounces: 4/' "$lens" >four_bounces.yaml
    for formula in term k_r_by_1e-4 normal_by_1e-4; do
        [ -d broken/$formula ] || break_shader $formula
        expect 1 "$VKWHITTED" check --shaders broken/$formula --against double --size 64x64 "$lens" four_bounces.yaml
        [ "$(grep -cE ' [0-9]+ unexplained @ \([0-9]+, [0-9]+\)  UNEXPLAINED$' out)" -eq 2 ] || fail "$formula"
    done
}

# A difference, then agreement: 1. A difference and a bad file: 2.
worst_status() {
    sed 's/, roughness: 0.6//' "$figure" >lambert.yaml # which has no rough term to be wrong
    expect 1 broken check $small "$figure" lambert.yaml
    expect 1 broken check $small lambert.yaml "$figure"
    expect 0 broken check $small lambert.yaml
    expect 2 broken check $small "$figure" no.yaml lambert.yaml
    [ "$(wc -l <out)" -eq 2 ] || fail 'not two scenes checked'
}

"$1"
