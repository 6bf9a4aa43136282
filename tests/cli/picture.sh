. "$(dirname "$0")/lib.sh"

# judged STATUS OPTION...: figure 4 is judged by its exact picture, with that exit status.
judged() {
    local status=$1
    shift
    expect "$status" "$VKWHITTED" check $small "$@" "$figure"
    [ "$(wc -l <out)" -eq 1 ] || fail 'not one line'
}

# A picture of one's own in any format has no wrong pixel; 8-bit files only as what they are.
right() {
    local file
    expect 0 "$VKWHITTED" render -q --backend cpu $small -o a.exr -o a.pfm -o a.png "$figure"
    expect 0 "$VKWHITTED" render -q --backend cpu $small --transfer linear -o linear.png "$figure"
    for file in a.exr a.pfm a.png; do
        judged 0 --picture $file
        said "^/.*/figure_4.yaml: $file against double: 2[0-9]+ pixels right, [0-9]+ near a decision, 0 wrong" out
        [ ! -s err ] || fail 'standard error'
    done
    judged 0 --transfer linear --picture linear.png
    judged 1 --picture linear.png
    said 'warning: linear.png: says that its values are linear, and is taken for sRGB; see --transfer'
    judged 0 --against quad --picture a.exr --crop 0,0,60,40
    judged 0 --precision float --max-bounces 5 --picture a.pfm
    expect 0 "$VKWHITTED" render -q --backend cpu $small --crop 20,10,30,20 -o part.pfm "$figure"
    judged 0 --crop 20,10,30,20 --picture part.pfm
}

# Another formula: a roughness of 0.60002 for 0.6 changes matte by less than 1e-4, more than float may and less than 8 bits
# show; Lambert's for Oren and Nayar's is wrong everywhere.
wrong_formula() {
    sed 's/roughness: 0.6/roughness: 0.60002/' "$figure" >rough.yaml
    expect 0 "$VKWHITTED" render -q --backend cpu $small -o a.exr -o a.png rough.yaml
    judged 1 --picture a.exr --heatmap wrong.png --json a.json
    said ' [0-9]{3,4} wrong \([0-9]{3,4} by less than 1e-4 of their value, 0 within 1000 roundings of an edge, 0 others\)' out
    wrong=$(json a.json scenes 0 wrong_pixels slightly)
    judged 0 --picture a.exr --allow "$wrong"
    not_said WRONG out
    judged 1 --picture a.exr --allow $((wrong - 1))
    judged 0 --picture a.exr --tolerance 0,1e-4
    judged 0 --picture a.png --heatmap right.png
    [ "$(wc -c <wrong.png)" -gt $((2 * $(wc -c <right.png))) ] || fail 'the heatmap is as empty as a black one'
    sed 's/, roughness: 0.6//' "$figure" >lambert.yaml
    expect 0 "$VKWHITTED" render -q --backend cpu $small -o a.png lambert.yaml
    judged 1 --picture a.png
    said ' of an edge, [0-9]{3,4} others\)' out
}

# One value of one pixel, column 10 and row 5, is 100.
wrong_pixel() {
    expect 0 "$VKWHITTED" render -q --backend cpu $small -o a.pfm "$figure"
    start=$(($(wc -c <a.pfm) - 60 * 40 * 12))
    printf '\0\0\310\102' | dd of=a.pfm bs=1 seek=$((start + ((39 - 5) * 60 + 10) * 12 + 4)) conv=notrunc status=none
    judged 1 --picture a.pfm --json a.json
    said ', 1 wrong \(.*, 1 others\); largest error [0-9.]+ @ \(10, 5, g\): 100, exactly .*  WRONG$' out
    said "see 'vkwhitted pixel .*/figure_4.yaml 10 5 --against double'"
    [ "$(json a.json scenes 0 largest_error x)" = 10 ] && [ "$(json a.json scenes 0 largest_error y)" = 5 ] &&
        [ "$(json a.json scenes 0 largest_error value_range 1)" = 100 ] && [ "$(json a.json scenes 0 right)" = false ] ||
        fail 'the JSON file'
    judged 0 --picture a.pfm --allow 1
    expect 0 "$VKWHITTED" render -q --backend cpu $small --crop 9,4,10,10 -o part.pfm "$figure"
    printf '\0\0\310\102' | dd of=part.pfm bs=1 seek=$(($(wc -c <part.pfm) - 12)) conv=notrunc status=none
    judged 1 --crop 9,4,10,10 --picture part.pfm # whose last value in the file is in the row on top
    said "see 'vkwhitted pixel .*/figure_4.yaml 18 4 --against double'"
}

refusals() {
    expect 0 "$VKWHITTED" render -q --backend cpu $small -o a.exr "$figure"
    refused 2 'a.exr: the picture must have 600x400 pixels, has 60x40$' check --picture a.exr "$figure"
    refused 2 'b.exr: cannot read: No such file or directory$' check --picture b.exr "$figure"
    refused 2 'a.jpg: a picture.s name must end in' check --picture a.jpg "$figure"
    head -c 3000 a.exr >short.exr
    refused 2 'short.exr: cannot read EXR: ' check $small --picture short.exr "$figure"
    cp a.exr a.png
    refused 2 'a.png: cannot read PNG: Not a PNG file$' check $small --picture a.png "$figure"
    refused 2 '--transfer is for the .png of --picture' check --transfer linear "$figure"
    refused 2 '--picture takes one scene file' check --picture a.exr "$figure" "$figure"
    for option in '--device 0' --validate --fast '--precision double' '--max-error 1e-3' '--backend cpu' "--shaders $SOURCE_DIR/shaders"; do
        refused 2 '--picture goes with no device, backend or precision' check $option --picture a.exr "$figure"
    done
}

"$1"
