. "$(dirname "$0")/lib.sh"

# broken NAME ARGUMENTS...: the pixel, with a shader in which that is wrong.
broken() {
    [ -d "broken/$1" ] || break_shader "$1"
    "$VKWHITTED" pixel --shaders "broken/$1" "${@:2}"
}

soft=$SOURCE_DIR/scenes/figure_2b.yaml

agreement() {
    for scene in "$figure" "$soft"; do
        for place in '0 0' '34 27' '59 39'; do
            expect 0 "$VKWHITTED" pixel $small --validate "$scene" $place
            said "^$scene: pixel \(${place/ /, }\): device and reference agree in [0-9]+ steps$" out
            not_said 'first difference|reference [0-9-]|not what was' out
            [ ! -s err ] || fail 'standard error'
        done
    done
}

samples() {
    expect 0 "$VKWHITTED" pixel $small --samples 3 "$figure" 34 27
    for sample in 0 1 2; do said "^primary ray, sample $sample$" out; done
    [ "$(grep -c '^sample [012]$' out)" -eq 3 ] || fail 'not three samples end'
}

max_bounces() {
    expect 0 "$VKWHITTED" pixel --max-bounces 0 "$figure" 200 230
    said '^  no further ray: max_bounces$' out
    [ "$(grep -c ' ray' out)" -eq 2 ] || fail 'more than the primary ray'
    expect 0 "$VKWHITTED" pixel --max-bounces 1 "$figure" 200 230
    said '^  refracted ray, bounce 1, from Sphere2$' out
    said '^  reflected ray, bounce 1, from Sphere2$' out
}

max_error() {
    expect 0 "$VKWHITTED" pixel --max-error 0 "$figure" 200 230
    not_said 'not traced' out
    expect 0 "$VKWHITTED" pixel --max-error 0.1 "$figure" 200 230
    said '^ +(reflected|refracted) ray not traced$' out
    said '^ +charge +[0-9.e-]*[1-9]' out
}

# differs_in NAME SCENE QUANTITY PLACE: what is wrong is pointed at.
differs_in() {
    expect 1 broken "$1" "$2" $4
    said "  <-- first difference: $3, device " out
    [ "$(grep -c '<-- first difference' out)" -eq 1 ] || fail 'not one first difference'
    said "^$2: pixel \(${4/ /, }\): DIFFERS, first in ${3%%[.[]*} of step [0-9]+$" out
}

broken_k_r() {
    differs_in k_r "$figure" k_r '200 230'
    device=$(sed -nE 's/.*k_r, device 0x([0-9a-f]+) .*/\1/p' out)
    reference=$(sed -nE 's/.*k_r, device .*, reference 0x([0-9a-f]+) .*/\1/p' out)
    [ $((0x$device - 0x$reference)) -eq 1 ] || fail 'not one unit in the last place'
    expect 0 broken k_r "$SOURCE_DIR/scenes/figure_2a.yaml" 200 230 # without glass
}

broken_shadow() {
    cat >shadow.yaml <<'END'
camera: { position: [0, 1, -4], look_at: [0, 0, 0] }
image: { width: 60, height: 40 }
materials: [ { name: Grey, type: matte, color: [0.5, 0.5, 0.5] } ]
objects:
  - { name: Floor, type: plane, point: [0, -1, 0], normal: [0, 1, 0], material: Grey }
  - { name: Above, type: sphere, center: [0, 9, 0], radius: 2, material: Grey }
lights: [ { type: point, position: [0, 3, 0], power: 10 } ]
END
    expect 1 broken shadow shadow.yaml 30 30
    said '^ +shadow +Above +reference nothing  <-- first difference: shadow, device Above, reference nothing$' out
    expect 0 "$VKWHITTED" pixel shadow.yaml 30 30
}

broken_normal() { differs_in normal "$figure" 'normal[.][xyz]' '200 230'; }

# Total reflection too early: the trees part.
broken_total() {
    differs_in total "$figure" total_reflection '200 230'
    said '^ +total_reflection yes  reference no  <--' out
    said '^  totally reflected ray, bounce 1, from Sphere2; the reference has no such ray$' out
    said '^the reference traces [0-9]+ rays that the device does not$' out
}

broken_term() { differs_in term "$figure" received '300 20'; }

# Only the picture's own pipeline is wrong, and what is recorded is right.
broken_picture() {
    expect 1 broken picture "$figure" 200 230
    said '^the picture has [0-9. ]+ here: not what was recorded$' out
    not_said 'first difference|DIFFERS' out
}

against() {
    for precision in double quad; do
        expect 0 "$VKWHITTED" pixel --against $precision "$figure" 200 230
        said '^ +k_r +0\.0692[0-9]+  \[[+-][0-9.]+ ulp, bound [0-9.]+\]$' out
        said '^ +margin +[0-9.e+]+$' out
    done
    expect 0 "$VKWHITTED" pixel --against quad "$figure" 340 268
    said 'float may decide otherwise' out
}

json_file() {
    expect 0 "$VKWHITTED" pixel -q --against quad --json result.json "$figure" 200 230
    [ "$(wc -l <out)" -eq 1 ] || fail 'not one line'
    json_is "$figure" result.json scene
    json_is true result.json agrees
    json_is 200 result.json x
    json_is 230 result.json y
    json_is ray result.json steps 0 step
    json_is 3 result.json steps 0 device direction
    json_is Sphere2 result.json steps 1 device meets
    json_is Sphere2 result.json steps 1 reference meets
    json_is 3 result.json steps 1 quad bounds normal
    steps=$(json result.json steps)
    said "agree in $steps steps" out
    json_is "$(json result.json steps $((steps - 1)) device radiance 0)" result.json radiance 0
    expect 1 broken k_r -q --json result.json "$figure" 200 230
    json_is false result.json agrees
    json_is k_r result.json first_difference quantity
    json result.json first_difference device_bits | grep -qE '^0x[0-9a-f]{8}$' || fail device_bits
    json_is 2 result.json first_difference step
    only_files result.json
}

light_samples() {
    expect 0 "$VKWHITTED" pixel --light-samples 500 "$soft" 300 330
    said '^  quad light 1: [0-9]+ of 500 samples lit, [0-9]+ in shadow; sum of received x area [0-9.]+$' out
    [ "$(wc -l <out)" -lt 40 ] || fail 'a flood'
    expect 0 "$VKWHITTED" pixel -v --light-samples 500 "$soft" 300 330
    [ "$(grep -cE '^  quad light 1, sample [0-9]+$' out)" -eq 500 ] || fail 'not all samples'
}

place() {
    refused 2 'pixel 600 0: expected a column from 0 to 599 and a row from 0 to 399' pixel "$figure" 600 0
    refused 2 'pixel 0 40: expected a column from 0 to 59 and a row from 0 to 39' pixel $small "$figure" 0 40
    for number in 1x 1.5 '' ' 1' 0x1 99999999999; do
        refused 2 "pixel $number 0: expected the column and the row" pixel "$figure" "$number" 0
        refused 2 "pixel 0 $number: expected the column and the row" pixel "$figure" 0 "$number"
    done
    refused 2 'pixel takes a scene file, a column and a row' pixel "$figure" 1
    refused 2 'pixel takes a scene file, a column and a row' pixel "$figure" 1 2 3
    refused 2 'pixel takes a scene file, a column and a row' pixel
}

options() {
    refused 2 'pixel computes in float or double' pixel --precision quad "$figure" 1 1
    refused 2 '--max-error does not go with --against' pixel --max-error 1 --against quad "$figure" 1 1
    expect 0 "$VKWHITTED" pixel --precision double "$figure" 200 230
    said ', double; metres$' out
    only_files
}

"$1"
