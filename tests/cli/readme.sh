. "$(dirname "$0")/lib.sh"

# What README.md shows is run, in a folder that looks like the source: the commands of ```sh with pictures of 24x16
# pixels, those of ```console as they are, and their output must be what stands there.

readme=$SOURCE_DIR/README.md
mkdir bin build
cp -r "$SOURCE_DIR/shaders" .
cp -r "$SOURCE_DIR/scenes" small
sed -i 's/^image: .*/image: { width: 24, height: 16 }/' small/*.yaml small/hard/*.yaml
cat >bin/vkwhitted <<'END'
#!/bin/bash
# With small scenes in ./scenes names mean those. Of bench, which takes half a minute, the options are read.
words=()
for word in "$@"; do
    [ ! -e scenes/small ] || [ ! -e "scenes/$word.yaml" ] || word=scenes/$word.yaml
    words+=("$word")
done
[ "$1" != bench ] || words+=(--help)
exec "$VKWHITTED" "${words[@]}"
END
# What changes the machine, or takes other tests their time, is done only in name.
for name in bootstrap cpack sudo apt-get sbatch; do printf '#!/bin/sh\nexit 0\n' >bin/$name; done
cat >bin/parallel <<'END'
#!/bin/bash -e
# What GNU parallel has hosts do, with as many rows as tiles.
[ "${*: -18:2}" = '{}.exr :::' ]
for i in "${@: -16}"; do vkwhitted render -q scenes/figure_4.yaml --size 12x16 --tile $i/16 -o $i.exr; done
END
chmod +x bin/*
ln -s "$PWD/bin/vkwhitted" build/vkwhitted
ln -s bin/bootstrap .
touch build/vkwhitted_0.1.0_amd64.deb small/small
PATH=$PWD/bin:$PATH

# blocks LANGUAGE: the files LANGUAGE.1, ... in ./blocks get what stands behind ```LANGUAGE.
blocks() {
    mkdir -p blocks
    awk -v language="$1" '
        /^```/ { inside = $0 == "```" language; if (inside) file = "blocks/" language "." ++count; next }
        inside { print >file }' "$readme"
}

commands() {
    ln -sfn small scenes
    blocks sh
    for block in blocks/sh.*; do
        bash -e "$block" >out 2>err </dev/null || fail "$block: $(cat "$block")"
    done
    [ "$(ls blocks | wc -l)" -ge 4 ] || fail 'where are they?'
    [ -s figure_4.png ] || fail 'no picture'
}

# session FILE: runs the lines that begin with "$ ", and compares. Of watch, which does not end, the first lines but
# for their numbers.
session() {
    while IFS= read -r line; do
        [[ $line == '$ '* ]] || continue
        echo "$line"
        if [[ $line == *' watch '* ]]; then
            bash -c "exec ${line#??}" >err 2>&1 &
            local end=$((SECONDS + 60))
            until [ "$(wc -l <err)" -ge 2 ] || [ $SECONDS -gt $end ]; do sleep 0.05; done
            kill -INT $!
            wait $!
            head -2 err | sed -E 's/[0-9]+\.[0-9] ms/T ms/g; s/after [0-9]+ ms/after T ms/'
        else
            bash -c "${line#??}" 2>&1 | sed "s,$SOURCE_DIR/scenes,/usr/share/vkwhitted/scenes,"
        fi
    done <"$1"
}

sessions() {
    ln -sfn "$SOURCE_DIR/scenes" scenes
    blocks console
    set -m # or else watch ignores SIGINT
    for block in blocks/console.*; do
        session "$block" >out
        sed -E '/^vkwhitted: picture/ { s/[0-9]+\.[0-9] ms/T ms/g; s/after [0-9]+ ms/after T ms/ }' "$block" | diff - out || fail "$block"
    done
    [ "$(ls blocks | wc -l)" -ge 5 ] || fail 'where are they?'
}

# The scene file, and what others' CI is told to do.
files() {
    ln -sfn small scenes
    blocks yaml
    "$BINARY_DIR/make_spheres" flake 1 >flake.npy || fail make_spheres
    for block in blocks/yaml.*; do
        expect 0 fy-tool --testsuite "$block"
        case $(head -1 "$block") in
        camera:*)
            cp "$block" room.yaml
            expect 0 vkwhitted check $small room.yaml
            ;;
        *)
            sed -nE 's/^ *- (run: )?(apt-get|vkwhitted)/\2/p' "$block" >commands
            grep -q '^vkwhitted check' commands || fail "no check in $block"
            sed -i 's/ check / check --size 12x8 /' commands
            if [ -e run ]; then # for another CI
                cmp commands run || fail 'other commands'
            else
                cp commands run
                expect 0 bash -e run
                expect 0 xmllint --noout --relaxng "$SOURCE_DIR/tests/cli/junit.rng" check.xml
            fi
            ;;
        esac
    done
    [ "$(ls blocks | wc -l)" -eq 3 ] || fail 'not three of them'
    expect 0 fy-tool --testsuite "$SOURCE_DIR/.github/workflows/check.yml"
}

"$1"
