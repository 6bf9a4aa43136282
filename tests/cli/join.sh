. "$(dirname "$0")/lib.sh"

# tile I/N FILE OPTION...
tile() {
    local tile=$1 file=$2
    shift 2
    expect 0 "$VKWHITTED" render -q $small "$figure" --tile "$tile" -o "$file" "$@"
}
cpu='--backend cpu'

# Tiles of the device and of the reference make the picture that one of them renders whole.
tiles() {
    expect 0 "$VKWHITTED" render -q $small "$figure" -o whole.pfm -o whole.exr
    tile 1/3 1.exr
    tile 2/3 2.exr $cpu
    tile 3/3 3.exr
    expect 0 "$VKWHITTED" join 2.exr 1.exr 3.exr -o joined.pfm -o joined.exr -o joined.png
    said '60x40 from 3 tiles'
    cmp whole.pfm joined.pfm || fail 'other bits'
    expect 0 "$VKWHITTED" join 2.exr 1.exr 3.exr -o linear.png --transfer linear
    ! cmp -s joined.png linear.png || fail '--transfer is not heard'
    refused 2 'joined.exr: expected a tile' join 1.exr joined.exr -o a.pfm
    # of a part of the picture, with double precision and bounds on what is cut off
    for tile in 1 2 3 4 5; do tile $tile/5 c$tile.exr $cpu --crop 10,5,30,13 --precision double --max-bounces 2; done
    expect 0 "$VKWHITTED" join c?.exr -o c.pfm
    expect 0 "$VKWHITTED" render -q $small "$figure" $cpu --crop 10,5,30,13 --precision double --max-bounces 2 -o d.pfm
    cmp c.pfm d.pfm || fail 'other bits of a crop'
}

# Tiles of two drivers, which have no code in common, and of the reference.
drivers() {
    local picture="$figure --size 150x100"
    expect 0 "$VKWHITTED" render -q $picture $cpu -o whole.pfm
    expect 0 "$VKWHITTED" render -q $picture --tile 1/3 -o 1.exr --device llvmpipe
    VK_ICD_FILENAMES=$SWIFTSHADER VK_DRIVER_FILES=$SWIFTSHADER \
        expect 0 "$VKWHITTED" render -q $picture --tile 2/3 -o 2.exr --device SwiftShader
    expect 0 "$VKWHITTED" render -q $picture --tile 3/3 -o 3.exr $cpu
    expect 0 "$VKWHITTED" join 1.exr 2.exr 3.exr -o joined.pfm -o joined.exr
    cmp whole.pfm joined.pfm || fail 'other bits'
    for device in llvmpipe SwiftShader cpu; do
        head -c 4096 joined.exr | grep -aq "$device" || fail "the picture does not say that $device is one of its devices"
    done
}

# What does not belong together is named.
refusals() {
    local array=$SOURCE_DIR/scenes/hard/camera_in_cloud
    for tile in 1 2 3 4 5 6 7; do tile $tile/7 $tile.exr $cpu; done
    refused 2 '3 of 7 tiles are missing: 2, 4-5' join 1.exr 3.exr 6.exr 7.exr -o a.pfm
    expect 2 "$VKWHITTED" join ?.exr 3.exr -o a.pfm
    said '3.exr and 3.exr are both tile 3 of 7'
    tile 2/7 other.exr $cpu --samples 2
    expect 2 "$VKWHITTED" join 1.exr [3-7].exr other.exr -o a.pfm
    said 'other.exr: has other settings than 1.exr: .*--samples 2.*, not .*--samples 1'
    said '1 of 7 tiles is missing: 2'
    tile 2/8 other.exr $cpu
    expect 2 "$VKWHITTED" join 1.exr [3-7].exr other.exr -o a.pfm
    said 'other.exr: is one of 8 tiles, 1.exr is one of 7'
    # one light, or one bit of one sphere in a file
    sed 's/power: 100 }/power: 101 }/' "$figure" >figure.yaml
    expect 0 "$VKWHITTED" render -q $small figure.yaml $cpu --tile 2/7 -o other.exr
    expect 2 "$VKWHITTED" join 1.exr [3-7].exr other.exr -o a.pfm
    said 'other.exr: is of another scene than 1.exr: figure.yaml'
    cp "$array.yaml" "$array.npy" .
    expect 0 "$VKWHITTED" render -q --size 6x4 camera_in_cloud.yaml $cpu --tile 1/2 -o 1.exr
    size=$(wc -c <camera_in_cloud.npy)
    byte=$(tail -c 4 camera_in_cloud.npy | head -c 1 | od -An -tu1) # the lowest of the last sphere's radius
    printf "\\$(printf %o $((byte ^ 1)))" | dd of=camera_in_cloud.npy bs=1 seek=$((size - 4)) conv=notrunc status=none
    expect 0 "$VKWHITTED" render -q --size 6x4 camera_in_cloud.yaml $cpu --tile 2/2 -o 2.exr
    expect 2 "$VKWHITTED" join 1.exr 2.exr -o a.pfm
    said '2.exr: is of another scene than 1.exr'
    head -c 1000 2.exr >cut.exr
    refused 2 'cut.exr: cannot read EXR' join 1.exr cut.exr -o a.pfm
    refused 2 'none.exr: cannot read' join none.exr -o a.pfm
    [ ! -e a.pfm ] || fail 'there is a picture'
}

usage() {
    refused 2 'join needs -o FILE' join 1.exr
    refused 2 "join takes the files of a picture's tiles" join -o a.pfm
    refused 2 '--tile writes .exr' render "$figure" --tile 1/2 -o a.png
    refused 2 '--tile 3/2: expected I/N' render "$figure" --tile 3/2 -o a.exr
    refused 2 '--tile 0/2: expected I/N' render "$figure" --tile 0/2 -o a.exr
    refused 2 '--tile 1/41: there are no more than 40 rows' render $small "$figure" --tile 1/41 -o a.exr
    only_files
}

# The data that tiles hold is damaged: nothing is written.
damaged() {
    for tile in 1 2; do tile $tile/2 $tile.exr $cpu; done
    size=$(wc -c <2.exr)
    head -c $((size / 2)) 2.exr >cut.exr # in the middle of the colours
    for suffix in png exr pfm; do
        refused 2 'cut.exr: cannot read EXR' join 1.exr cut.exr -o a.$suffix
        only_files 1.exr 2.exr cut.exr
    done
}

# A picture of 48 MiB in 60 MB, of which the program takes half.
larger_than_memory() {
    local scene=$SOURCE_DIR/tests/scenes/no_objects.yaml picture='--size 4096x1024 --backend cpu'
    for tile in 1 2; do expect 0 "$VKWHITTED" render -q $picture "$scene" --tile $tile/2 -o $tile.exr; done
    expect 0 "$VKWHITTED" join 1.exr 2.exr -o a.pfm -o a.exr -o a.png
    (
        ulimit -v 60000
        expect 3 "$VKWHITTED" render -q $picture "$scene" -o b.pfm
        expect 0 "$VKWHITTED" join 1.exr 2.exr -o b.pfm -o b.exr -o b.png
    ) || exit 1
    cmp a.pfm b.pfm && cmp a.exr b.exr && cmp a.png b.png || fail 'other bytes'
}

"$1"
