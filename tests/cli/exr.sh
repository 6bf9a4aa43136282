. "$(dirname "$0")/lib.sh"

# Programs that read EXR files see the colours, of which there are three, although bounds on what is cut off stand beside
# them. $TOOL is the program.
render_all() {
    expect 0 "$VKWHITTED" render --size 90x60 --max-bounces 3 "$figure" -o a.exr -o a.pfm -o linear.png --transfer linear
}

exrinfo() {
    render_all
    "$TOOL" a.exr >out # whose exit status means nothing
    [ "$(grep -A8 'part 1: picture' out | grep -c "^   '[BGR]': float")" -eq 3 ] || fail 'no three channels'
    said 'part 1: picture' out
    said 'channels: 3 channels' out
    said 'part 2: truncation' out
    expect 0 "$VKWHITTED" render --size 90x60 --max-bounces 0 "$SOURCE_DIR/tests/scenes/no_objects.yaml" -o b.exr
    "$TOOL" b.exr >out
    not_said 'part 2|truncation' out # there is nothing to say
    expect 0 "$VKWHITTED" render --size 90x60 --crop 20,10,30,40 "$figure" -o b.exr
    "$TOOL" b.exr >out
    said 'displayWindow: \[ 0, 0 - 89 59 \] 90 x 60' out
    said 'dataWindow: \[ 20, 10 - 49 49 \] 30 x 40' out
}

openimageio() {
    render_all
    expect 0 "$TOOL" a.exr -o oiiotool.png
    expect 0 "${TOOL%oiiotool}iconvert" a.exr iconvert.png
    for file in oiiotool.png iconvert.png; do
        expect 0 "$TOOL" --info $file
        said '3 channel' out
        expect 0 "$TOOL" --fail 0.004 --diff $file linear.png # a step of 8 bits
    done
    expect 0 "$TOOL" a.exr -o a.tif a.pfm -o b.tif --fail 0 --diff
}

imagemagick() {
    render_all
    expect 0 "$TOOL" a.exr im.png
    expect 0 "$TOOL" im.png linear.png -alpha off -metric AE -fuzz 1% -compare -format '%[distortion]' info:
    [ "$(cat out)" = 0 ] || fail 'other colours'
}

ffmpeg() {
    render_all
    expect 0 "$TOOL" -loglevel error -i a.exr -pix_fmt gbrpf32le -f rawvideo exr.raw
    expect 0 "$TOOL" -loglevel error -i a.pfm -pix_fmt gbrpf32le -f rawvideo pfm.raw
    expect 0 "$TOOL" -loglevel error -i a.pfm -vf vflip -pix_fmt gbrpf32le -f rawvideo flipped.raw # some show it upside down
    [ "$(wc -c <exr.raw)" -eq $((90 * 60 * 12)) ] || fail 'the size'
    cmp exr.raw pfm.raw || cmp exr.raw flipped.raw || fail 'other bits'
}

opencv() {
    render_all
    OPENCV_IO_ENABLE_OPENEXR=1 expect 0 "$TOOL" -c '
import cv2
a, b = (cv2.imread(name, cv2.IMREAD_UNCHANGED) for name in ("a.exr", "a.pfm"))
assert a.shape == (60, 90, 3) and a.max() > 0.5 and (a == b).all()'
}

"$1"
