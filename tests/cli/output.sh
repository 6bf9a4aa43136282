. "$(dirname "$0")/lib.sh"

magic() { head -c "$2" "$1" | od -An -tx1 | tr -d ' \n'; }

formats() {
    expect 0 "$VKWHITTED" render $small "$figure" -o a.png -o b.exr -o c.pfm -o d.PNG
    only_files a.png b.exr c.pfm d.PNG
    [ "$(magic a.png 8)" = 89504e470d0a1a0a ] || fail 'a.png is no PNG'
    [ "$(magic b.exr 4)" = 762f3101 ] || fail 'b.exr is no OpenEXR file'
    [ "$(head -2 c.pfm | tr '\n' ' ')" = 'PF 60 40 ' ] || fail 'c.pfm is no PFM file'
    [ "$(wc -c <c.pfm)" -eq $((60 * 40 * 12 + 3 + 6 + 5)) ] || fail 'the size of c.pfm'
    said '60x40 in [0-9.]+ ms on '
}

same_bits_on_both_backends() {
    expect 0 "$VKWHITTED" render $small "$figure" -o device.pfm
    expect 0 "$VKWHITTED" render $small "$figure" -o cpu.pfm --backend cpu
    expect 0 "$VKWHITTED" render $small "$figure" -o one.pfm --backend cpu --threads 1
    expect 0 "$VKWHITTED" render $small "$figure" -o double.pfm --backend cpu --precision double
    expect 0 "$VKWHITTED" render $small "$figure" -o part.pfm --crop 20,10,1,1
    cmp device.pfm cpu.pfm || fail 'device and reference differ'
    cmp cpu.pfm one.pfm || fail 'the number of threads matters'
    ! cmp -s cpu.pfm double.pfm || fail 'double is float'
    offset=$((14 + ((40 - 1 - 10) * 60 + 20) * 12)) # rows from the bottom
    [ "$(tail -c +$((offset + 1)) device.pfm | magic /dev/stdin 12)" = "$(tail -c 12 part.pfm | magic /dev/stdin 12)" ] ||
        fail 'the crop is another part'
}

exr_metadata() {
    expect 0 "$VKWHITTED" render $small "$figure" -o a.exr --max-bounces 7
    # attribute: name, type, size, value
    tr '\0' ' ' <a.exr | head -c 4096 >header
    for attribute in 'scene string .*figure_4.yaml' 'device string ' 'precision string ....float' 'maxBounces int '; do
        grep -aq "$attribute" header || fail "no '$attribute' in the header"
    done
    rm header
}

transfer() {
    expect 0 "$VKWHITTED" render $small "$figure" -o srgb.png
    expect 0 "$VKWHITTED" render $small "$figure" -o also_srgb.png --transfer srgb
    expect 0 "$VKWHITTED" render $small "$figure" -o linear.png --transfer linear
    cmp srgb.png also_srgb.png || fail 'srgb is not the default'
    ! cmp -s srgb.png linear.png || fail 'no difference'
    expect 0 "$VKWHITTED" render $small "$figure" -o srgb.pfm --transfer srgb
    expect 0 "$VKWHITTED" render $small "$figure" -o linear.pfm --transfer linear
    cmp srgb.pfm linear.pfm || fail 'a PFM has no transfer function'
}

unknown_suffix() {
    refused 2 'a.jpg: ' render $small "$figure" -o a.jpg
    refused 2 'png: ' render $small "$figure" -o png
    refused 2 'a.png/b: ' render $small "$figure" -o a.png/b
    refused 2 'b.tiff: ' render $small "$figure" -o a.png -o b.tiff
    only_files
}

unwritable_folder() {
    mkdir sealed && chmod a-w sealed
    [ ! -w sealed ] || { # root may write anywhere but here
        refused 3 '/proc/a.png: ' render $small "$figure" -o /proc/a.png
        refused 3 '/proc/a.json: ' check $small "$figure" --json /proc/a.json
        return
    }
    refused 3 'sealed/a.png: ' render $small "$figure" -o sealed/a.png
}

missing_folder() {
    refused 3 'no/a.png: .*No such file' render $small "$figure" -o no/a.png
    refused 3 'no/a.json: .*No such file' render $small "$figure" --stats no/a.json
    mkdir a.png
    refused 3 'a.png: .*directory' render $small "$figure" -o a.png
}

# On a file system of 64 KiB where that may be made. Under a limit of file size with the reference only: a driver that
# keeps device memory in a file (Mesa 25) does not survive it.
disk_full() {
    for format in png exr pfm; do
        (ulimit -f 16; expect 3 "$VKWHITTED" render -q --backend cpu "$figure" -o a.$format; said "^vkwhitted: error: a.$format: cannot write: File too large$") || exit 1
        only_files
    done
    mkdir small
    unshare --mount sh -c 'mount -t tmpfs -o size=64k tmpfs small' 2>/dev/null || return 0
    for format in png exr pfm; do
        expect 3 unshare --mount sh -c "mount -t tmpfs -o size=64k tmpfs small || exit 77
            \"$VKWHITTED\" render -q $figure -o small/a.$format
            status=\$?
            [ -z \"\$(ls -A small)\" ] || exit 99
            exit \$status"
        said "^vkwhitted: error: small/a.$format: cannot write: No space left on device$"
    done
}

existing_file_kept_on_failure() {
    echo precious >a.pfm
    (ulimit -f 16; expect 3 "$VKWHITTED" render -q --backend cpu "$figure" -o a.pfm) || exit 1
    [ "$(cat a.pfm)" = precious ] || fail 'the old file is gone'
    expect 2 "$VKWHITTED" render -q /dev/null -o a.pfm
    [ "$(cat a.pfm)" = precious ] || fail 'the old file is gone'
    only_files a.pfm
}

crop_of_16384() {
    expect 0 "$VKWHITTED" check --size 16384x16384 --crop 8000,11000,300,200 "$figure"
    said ' 0 of 60000 pixels differ' out
    expect 0 "$VKWHITTED" check --size 65536x65536 --crop 65436,65436,100,100 "$figure"
    said ' 0 of 10000 pixels differ' out
}

size_16384() {
    expect 0 "$VKWHITTED" render --size 16384x16384 "$figure" -o a.pfm
    [ "$(wc -c <a.pfm)" -eq $((16384 * 16384 * 12 + 3 + 12 + 5)) ] || fail 'the size of a.pfm'
}

stats_positive() { awk -v x="$(json stats.json $1)" 'BEGIN { exit !(x > 0 && x < 1e15) }' || fail "$1 is not positive"; }

stats() {
    local device_rays
    expect 0 "$VKWHITTED" render $small --samples 2 --max-bounces 3 --repeat 2 "$figure" --stats stats.json
    json_is "$figure" stats.json scene
    json_is 60 stats.json width
    json_is 40 stats.json height
    json_is float stats.json precision
    json_is exact stats.json mode
    json_is 3 stats.json max_bounces
    json_is 2 stats.json samples
    json_is 32 stats.json light_samples
    json_is $((60 * 40 * 2)) stats.json rays primary
    for key in setup_ms first_dispatch_ms dispatch_ms rays_per_second; do stats_positive $key; done
    [ -n "$(json stats.json device)" ] && [ -n "$(json stats.json driver)" ] || fail 'no device'
    json stats.json write_ms >/dev/null
    device_rays=$(json stats.json rays secondary)/$(json stats.json rays shadow)
    expect 0 "$VKWHITTED" render $small --samples 2 --max-bounces 3 --backend cpu "$figure" --stats stats.json
    json_is cpu stats.json device
    json_is $((60 * 40 * 2)) stats.json rays primary
    [ "$(json stats.json rays secondary)/$(json stats.json rays shadow)" = "$device_rays" ] || fail 'ray counts differ'
    expect 0 "$VKWHITTED" render $small --max-bounces 0 --crop 1,2,3,4 --fast "$figure" --stats stats.json
    json_is 3 stats.json width
    json_is 4 stats.json height
    json_is fast stats.json mode
    json_is 12 stats.json rays primary
    json_is 0 stats.json rays secondary
    only_files stats.json
}

"$1"
