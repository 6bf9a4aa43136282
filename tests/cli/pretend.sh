. "$(dirname "$0")/lib.sh"

export VK_ADD_LAYER_PATH=$LAYER VK_INSTANCE_LAYERS=VK_LAYER_VKWHITTED_pretend

# Staging buffers, a row an invocation, groups of 8x8, no subgroup operations: in every bit the same.
agreement_as_graphics_card() {
    export PRETEND_GPU=1
    expect 0 "$VKWHITTED" devices
    said 'pretended graphics card' out
    said 'type            discrete GPU' out
    expect 0 "$VKWHITTED" check -q --validate --size 97x61 "$SOURCE_DIR"/scenes/figure_*.yaml "$SOURCE_DIR"/scenes/hard/{bubble,diamond,facing_mirrors,ground_sphere,thin_shell,touching}.yaml
    expect 0 "$VKWHITTED" check -q --size 60x40 --samples 3 --light-samples 5 "$SOURCE_DIR"/scenes/figure_{2b,4}.yaml
    expect 0 "$VKWHITTED" check -q --size 30x20 --max-bounces 64 "$SOURCE_DIR/scenes/hard/diamond.yaml"
    # so many slots that there is no room for an invocation a pixel
    expect 0 "$VKWHITTED" check -q --size 160x100 --max-bounces 1000 "$SOURCE_DIR/scenes/figure_4.yaml"
    expect 0 "$VKWHITTED" check -q --size 4x4 --light-samples 65536 "$SOURCE_DIR/scenes/figure_2b.yaml"
}

# A dispatch has at least a million pixels or the whole picture, and at most 2 % of invocations outside of it.
dispatch_sizes() {
    export PRETEND_GPU=1 PRETEND_LOG=$PWD/dispatches
    expect 0 "$VKWHITTED" render -q --size 1920x1080 "$figure"
    tail -n +2 dispatches | awk '{ n += $1 * $2 * 64 } END { exit !(NR == 1 && n <= 1.02 * 1920 * 1080) }' ||
        fail "$(cat dispatches)"
    rm dispatches
    expect 0 "$VKWHITTED" render -q --size 1200x900 --samples 64 --max-bounces 1 "$figure"
    tail -n +2 dispatches | awk '{ n += $1 * $2 * 64 } END { exit !(NR == 2 && n <= 2.04 * 1200 * 900) }' ||
        fail "$(cat dispatches)"
    rm dispatches
    unset PRETEND_GPU
    expect 0 "$VKWHITTED" render -q --size 1920x1080 "$figure"
    test "$(tail -n +2 dispatches | wc -l)" = 1 || fail "$(cat dispatches)"
}

# Vectors of 16 lanes, which a processor has or not.
agreement_with_long_vectors() {
    export LP_NATIVE_VECTOR_WIDTH=512
    expect 0 "$VKWHITTED" check -q --size 97x61 "$SOURCE_DIR"/scenes/figure_{2b,4}.yaml "$SOURCE_DIR/scenes/hard/touching.yaml"
    expect 0 "$VKWHITTED" check -q --size 450x300 "$SOURCE_DIR"/scenes/figure_4.yaml
}

# More spheres than the device's buffers can hold: an error with both numbers; and none where they just fit.
texel_limit() {
    local flake="$SOURCE_DIR/scenes/sphereflake.yaml" limit
    export PRETEND_TEXELS
    for limit in 4096 30000; do # too few for records, and for words only
        PRETEND_TEXELS=$limit
        refused 3 "the spheres need a buffer of [0-9]+ texels; llvmpipe.* has them with up to $limit\$" render $small -o a.png "$flake"
        only_files
    done
    PRETEND_TEXELS=$(sed 's/.* of \([0-9]*\) texels.*/\1/' err)
    [ "$PRETEND_TEXELS" -gt 30000 ] || fail "$PRETEND_TEXELS"
    expect 0 "$VKWHITTED" render -q $small -o a.png "$flake"
}

"$1"
