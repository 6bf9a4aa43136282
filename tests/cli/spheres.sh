. "$(dirname "$0")/lib.sh"

make_spheres=$BINARY_DIR/make_spheres

camera='{ position: [0, 6, -16], look_at: [0, 0, 0] }'

# scene FILE OBJECT_LINE...: a scene with these objects over a floor.
scene() {
    local file=$1
    shift
    cat >"$file" <<EOF
camera: $camera
image: { width: 61, height: 41 }
materials:
  - { name: White, type: matte, color: [0.9, 0.9, 0.9], roughness: 0.3 }
  - { name: Chrome, type: mirror }
  - { name: Glass, type: transparent, ior: 1.5 }
objects:
$(printf '  - %s\n' "$@")
  - { name: Floor, type: plane, point: [0, -9, 0], normal: [0, 1, 0], material: White }
lights:
  - { type: point, position: [9, 20, -9], power: 1000 }
EOF
}

rows() { echo "{ name: Flake, type: spheres, file: $1, material: $2 }"; }

# refused_file PATTERN: flake.npy is refused at its place in the scene file, with the line and a caret.
refused_file() {
    expect 2 "$VKWHITTED" render a.yaml -o a.png
    said "^a.yaml:8:41: error: spheres \"Flake\": flake.npy: $1\$"
    sed -n 2p err | grep -qF "file: flake.npy" || fail 'the line itself is not shown'
    [ "$(sed -n 3p err)" = "$(printf '%41s' '^')" ] || fail 'no caret'
    [ "$(wc -l <err)" -eq 3 ] || fail 'more than one message'
    [ ! -e a.png ] || fail 'a picture'
}

bad_files() {
    scene a.yaml "$(rows flake.npy White)"
    refused_file 'No such file or directory'
    mkfifo flake.npy
    refused_file 'is not a regular file'
    rm flake.npy
    "$make_spheres" cloud 50 >good.npy
    head -c 200 good.npy >flake.npy
    refused_file 'is truncated: its header says 50 rows, it ends in row 4'
    cp good.npy flake.npy
    printf '\0\0\200\277' | dd of=flake.npy bs=1 seek=$((128 + 16 * 17 + 12)) conv=notrunc status=none
    refused_file 'row 17: radius must be > 0, is -1'
    cp good.npy flake.npy
    expect 0 "$VKWHITTED" render a.yaml -o a.png
}

# The same picture as of the same spheres in the scene file, on both backends and in all precisions.
rows_as_objects() {
    "$make_spheres" cloud 20 >flake.npy
    local i=0 row lines=()
    while read -r row; do
        set -- $row
        lines+=("{ name: S$i, type: sphere, center: [$1, $2, $3], radius: $4, material: Chrome }")
        i=$((i + 1))
    done < <(od -An -v -tf4 -w16 -j128 flake.npy)
    [ $i -eq 20 ] || fail "$i rows"
    scene rows.yaml "$(rows flake.npy Chrome)"
    scene objects.yaml "${lines[@]}"
    for options in '' '--backend cpu' '--precision double' '--max-error 1e-3'; do
        expect 0 "$VKWHITTED" render $options rows.yaml -o rows.pfm
        expect 0 "$VKWHITTED" render $options objects.yaml -o objects.pfm
        cmp rows.pfm objects.pfm || fail "another picture with $options"
    done
    scene floor.yaml '{ name: Far, type: sphere, center: [0, 99, 0], radius: 1, material: White }'
    expect 0 "$VKWHITTED" render floor.yaml -o floor.pfm --max-error 1e-3
    ! cmp -s rows.pfm floor.pfm || fail 'no spheres in the picture'
}

# Few, which are looped over, and many, which are not: between objects, in a folder of their own.
names_of_rows() {
    mkdir arrays
    for count in 10 40; do
        "$make_spheres" plane $count >arrays/flake.npy
        set -- $(od -An -v -tf4 -w16 -j$((128 + 16 * 7)) -N16 arrays/flake.npy)
        camera="{ position: [$1, 5, $3], look_at: [$1, 0, $3], up: [0, 0, 1] }"
        scene a.yaml '{ name: First, type: sphere, center: [0, 30, 0], radius: 30, material: Glass }' \
            "$(rows arrays/flake.npy White)" \
            '{ name: Last, type: sphere, center: [0, 99, 0], radius: 1, material: Glass }'
        expect 0 "$VKWHITTED" pixel a.yaml 30 20
        said '^  meets +First$' out
        said '^ +meets +"Flake" row 7$' out
    done
    expect 0 "$VKWHITTED" pixel a.yaml 30 20 --json a.json
    grep -qF '"\"Flake\" row 7"' a.json || fail 'no row in the JSON file'
}

# agrees SCENE KIND COUNT: with so many spheres the hard scene's picture is the reference's, and explained.
agrees() {
    cp "$SOURCE_DIR/scenes/hard/$1.yaml" .
    "$make_spheres" "$2" "$3" >"$1.npy"
    expect 0 "$VKWHITTED" check --size 48x32 "$1.yaml"
    said ': 0 of 1536 pixels differ' out
    expect 0 "$VKWHITTED" check --size 48x32 --against double "$1.yaml"
    said ' 0 unexplained' out
}
coincident_20000() { agrees coincident_spheres coincident 20000; }
million_grains() { agrees giant_and_grains grains 1000000; }

# Those of the repository are what the program beside them makes.
arrays() {
    while read -r file arguments; do
        expect 0 "$make_spheres" $arguments
        cmp out "$SOURCE_DIR/scenes/$file.npy" || fail "$file.npy is another array"
        grep -q "^# .*make_spheres $arguments\$" "$SOURCE_DIR/scenes/$file.yaml" || fail "$file.yaml"
    done <<'EOF'
sphereflake flake 4
hard/coincident_spheres coincident 4000
hard/sphere_decades decades 3000
hard/spheres_in_a_plane plane 3000
hard/camera_in_cloud cloud 3000
hard/giant_and_grains grains 3000
EOF
    expect 2 "$make_spheres" flake 8
    expect 2 "$make_spheres" flake 4x
    expect 3 sh -c "'$make_spheres' flake 4 >/dev/full"
}

"$1"
