. "$(dirname "$0")/lib.sh"

no_command() {
    expect 2 "$VKWHITTED"
    [ ! -s out ] || fail 'standard output'
    said '^usage: vkwhitted render SCENE'
}

unknown_command() {
    refused 2 'rendr: expected a command' rendr "$figure"
    refused 2 ': expected a command' '' "$figure"
    refused 2 '-q: expected a command' -q
}

unknown_option() {
    refused 2 '--sizes: no such option' render --sizes 60x40 "$figure"
    refused 2 '--fast=1: no such option, or not in this form' render --fast=1 "$figure"
    refused 2 '-x: no such option' render -x "$figure"
    refused 2 '-x: no such option' render -qx "$figure"
    [ "$(wc -l <err)" -eq 1 ] || fail 'not one line'
}

missing_argument() {
    refused 2 '--size: expected a value behind it' render "$figure" --size
    refused 2 '-o: expected a value behind it' render "$figure" -o
}

# A value may look like an option only where it cannot be one.
value_like_an_option() {
    refused 2 '--json: expected a value behind it; if --size is meant, write --json=--size$' check --json --size "$figure"
    refused 2 '-o: expected a value behind it; if -q is meant, write -o-q$' render -o -q "$figure"
    refused 2 '--device: expected a value behind it; if -1 is meant' render --device -1 "$figure"
    only_files
    expect 0 "$VKWHITTED" render -q $small "$figure" --stats=-x -o-y.png
    only_files -x -y.png
    expect 0 "$VKWHITTED" render -q $small -- "$figure"
}

size() {
    for size in 12x 0x5 5x0 x12 12 12x34x56 -1x5 '12 x5' 1e2x5 65537x1 99999999999999999999x5 0x10x5 ''; do
        refused 2 "--size $size: expected WIDTHxHEIGHT" render --size "$size" "$figure"
    done
    expect 0 "$VKWHITTED" render -q --size 1x1 "$figure"
}

numbers() {
    for number in 12x -1 1.5 '' ' 5' '[+]5' 0x10 99999999999999999999; do
        for option in --max-bounces --samples --light-samples --threads --repeat; do
            refused 2 "$option $number: expected a whole number from" render "$option" "${number//[\[\]]/}" "$figure"
        done
        refused 2 "--allow $number: expected a whole number from" check --allow "${number//[\[\]]/}" "$figure"
    done
    refused 2 '--max-bounces 1001: ' render --max-bounces 1001 "$figure"
    refused 2 '--samples 0: ' render --samples 0 "$figure"
    refused 2 '--light-samples 65537: ' check --light-samples 65537 "$figure"
    for tolerance in -1 1x 1,-1 1,2,3 nan inf ''; do
        refused 2 "--tolerance $tolerance: expected" check --tolerance "$tolerance" "$figure"
    done
}

crop() {
    for crop in 1,2,3 1,2,3,4,5 0,0,0,5 0,0,5,0 -1,0,5,5 1,2,3,4x ''; do
        refused 2 "--crop $crop: expected X,Y,WIDTH,HEIGHT" render --crop "$crop" "$figure"
    done
}

crop_outside() {
    for crop in 0,0,601,1 0,0,1,401 600,0,1,1 0,400,1,1 599,399,2,1 65536,65536,65536,65536; do
        refused 2 "--crop $crop: expected a part of the picture of 600x400" render --crop "$crop" "$figure"
    done
    refused 2 '--crop 0,0,61,1: expected a part of the picture of 60x40' check --size 60x40 --crop 0,0,61,1 "$figure"
    expect 0 "$VKWHITTED" render -q --crop 599,399,1,1 "$figure"
}

option_of_another_command() {
    refused 2 'check takes no option -o' check -o a.png "$figure"
    refused 2 'render takes no option --tolerance' render --tolerance 1 "$figure"
    refused 2 'pixel takes no option --fast' pixel --fast "$figure" 1 1
    refused 2 'join takes no option --samples' join 1.exr -o a.pfm --samples 2
    refused 2 'devices takes no option --size' devices --size 60x40
    only_files
}

choices() {
    refused 2 '--backend gpu: expected vulkan or cpu' render --backend gpu "$figure"
    refused 2 '--precision half: expected float or double or quad' render --precision half "$figure"
    refused 2 '--transfer gamma: expected srgb or linear' render --transfer gamma "$figure"
}

impossible_together() {
    refused 2 '--precision quad' render --precision quad "$figure"
    refused 2 '--fast ' render --fast --backend cpu "$figure"
    refused 2 '--device, --shaders and --validate' render --device 0 --backend cpu "$figure"
    refused 2 '--device, --shaders and --validate' render --validate --backend cpu "$figure"
    refused 2 '--device, --shaders and --validate' render --shaders . --backend cpu "$figure"
    refused 2 '--precision quad' watch --precision quad -o a.png "$figure"
    (unset DISPLAY WAYLAND_DISPLAY; refused 2 'watch needs -o FILE where there is no display' watch "$figure") || exit 1
    refused 2 '--heatmap FILE.png takes one scene' check --heatmap a.png "$figure" "$figure"
    for heatmap in a.exr a.txt a png; do
        refused 2 '--heatmap takes FILE.png or a folder' check --heatmap $heatmap "$figure"
    done
    only_files
}

number_of_scenes() {
    refused 2 'expected a scene file' check
    refused 2 'render takes one scene file' render "$figure" "$figure"
    refused 2 'watch takes one scene file' watch -o a.png "$figure" "$figure"
    refused 2 'devices takes no scene' devices "$figure"
}

help_and_version() {
    for arguments in --help -h 'render --help' 'check -h' 'devices --help'; do
        expect 0 "$VKWHITTED" $arguments
        said '^usage: vkwhitted render SCENE' out
        [ ! -s err ] || fail 'standard error'
    done
    "$VKWHITTED" --help | grep -E '^.{101}' && fail 'the help is wider than 100 columns'
    for option in $("$VKWHITTED" --help | grep -oE -- '--[a-z-]+' | sort -u); do
        "$VKWHITTED" render "$option" 2>&1 </dev/null | grep -q "no such option" && fail "$option in the help is no option"
    done
    expect 0 "$VKWHITTED" --version
    said '^vkwhitted [0-9]+\.[0-9]+\.[0-9]+$' out
    "$VKWHITTED" --help >/dev/full 2>err
    [ $? -eq 3 ] || fail 'a full standard output'
}

# The manual page has every option of the help, in the sections of the same commands.
manual_page() {
    local page=$BINARY_DIR/vkwhitted.1
    "$VKWHITTED" --help | sed -nE 's/^([a-z][a-z, ]+):$/\1/p; s/^  (-[^ ]+(, -[^ ]+)?( [^ ]+)?)  .*/\1/p' >expected
    [ "$(wc -l <expected)" -gt 40 ] || fail 'too few options in the help'
    sed -nE 's/^\.Ss ([a-z])/\1/p; /^\.It Fl/ { s/^\.It Fl /-/; s/ , Fl /, -/; s/ Ar / /; p }' "$page" |
        diff expected - || fail 'manual page'
    [ "$(grep -c '^\.Bl' "$page")" -eq "$(grep -c '^\.El' "$page")" ] || fail 'a list that does not end'
    command -v groff >/dev/null || return 0
    expect 0 groff -mdoc -Tutf8 -ww -z "$page"
    [ ! -s err ] || fail 'warnings of groff'
}

# completes LINE WORDS: what bash proposes for the last word of the line, the words in any order.
completes() {
    local COMP_WORDS COMP_CWORD COMPREPLY=()
    read -ra COMP_WORDS <<<"$1"
    [[ $1 != *' ' ]] || COMP_WORDS+=('')
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    _vkwhitted
    [ "$(printf '%s\n' "${COMPREPLY[@]}" | sort -u | paste -sd ' ')" = "$2" ] || fail "'$1' completes to '${COMPREPLY[*]}', expected '$2'"
}

completion() {
    . "$BINARY_DIR/completions/bash/vkwhitted"
    complete -p vkwhitted >out || fail 'not in use'
    mkdir folder
    touch a.yaml b.json c.png d.exr
    completes 'vkwhitted p' pixel
    completes 'vkwhitted ' '--help --version bench check devices join pixel render watch'
    completes 'vkwhitted check --ag' --against
    completes 'vkwhitted check --against ' 'double quad'
    completes 'vkwhitted render --precision ' 'double float quad'
    completes 'vkwhitted render --precision = d' double
    completes 'vkwhitted render --precision =' 'double float quad'
    completes 'vkwhitted render --h' --help
    completes 'vkwhitted render --ag' ''
    completes 'vkwhitted render --s' '--samples --shaders --size --stats'
    completes 'vkwhitted devices -' '--device --help --validate --version -h -q -v'
    completes 'vkwhitted render --size ' ''
    completes 'vkwhitted render --fast ' 'a.yaml folder'
    completes 'vkwhitted check a.yaml ' 'a.yaml folder'
    completes 'vkwhitted join ' 'd.exr folder'
    completes 'vkwhitted watch --shaders ' folder
    completes 'vkwhitted bench --compare ' 'b.json folder'
    completes 'vkwhitted check --heatmap ' 'c.png folder'
    completes 'vkwhitted render -o ' 'a.yaml b.json c.png d.exr folder out'
    if command -v zsh >/dev/null; then
        expect 0 zsh -n "$BINARY_DIR/completions/zsh/_vkwhitted"
    fi
    said '^#compdef vkwhitted$' "$BINARY_DIR/completions/zsh/_vkwhitted"
    for option in $("$VKWHITTED" --help | grep -oE -- '--[a-z-]+' | sort -u); do
        said "^  (-., )?$option " "$BINARY_DIR/completions/zsh/_vkwhitted"
    done
}

"$1"
