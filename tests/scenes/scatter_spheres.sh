#!/bin/bash
# scatter_spheres.sh COUNT: a scene of so many small spheres of all materials, the same for the same COUNT. Above 24
# objects the shader's loops stay loops, above 1024 it does not fit a uniform buffer of 64 KiB, and no bit
# mask has room for all of them; planes stand before, between and after the spheres.
set -eu
count=$1
random=12345
next() { # a whole number from 0 to $1 - 1 in $value
    random=$(((random * 1103515245 + 12345) % 2147483648))
    value=$((random / 65536 % $1))
}
thousandths() { # value / 1000
    local sign=''
    ((value >= 0)) || { sign=-; value=$((-value)); }
    printf -v number '%s%d.%03d' "$sign" $((value / 1000)) $((value % 1000))
}
cat <<HEAD
camera: { position: [0, 2, -6], look_at: [0, 2, 0], fov_y: 60 }
image: { width: 160, height: 107 }
background: [0.5, 0.25, 0.125]
light_samples: 2
materials:
  - { name: Matte0, type: matte, color: [0.8, 0.7, 0.6], roughness: 0.6 }
  - { name: Matte1, type: matte, color: [0.3, 0.5, 0.9] }
  - { name: Mirror, type: mirror }
  - { name: Glass, type: transparent, ior: 1.5 }
objects:
  - { name: Ground, type: plane, point: [0, -3, 0], normal: [0, 1, 0], material: Matte1 }
HEAD
materials=(Matte0 Matte1 Mirror Glass)
for ((i = 0; i < count; ++i)); do
    next 9000 && value=$((value - 4500)) && thousandths && x=$number
    next 9000 && value=$((value - 2500)) && thousandths && y=$number
    next 9000 && thousandths && z=$number
    next 250 && value=$((value + 50)) && thousandths && radius=$number
    next 4
    echo "  - { name: S$i, type: sphere, center: [$x, $y, $z], radius: $radius, material: ${materials[value]} }"
    ((i != count / 2)) || for ((plane = 0; plane < 20; ++plane)); do # behind the others, slanting
        echo "  - { name: P$plane, type: plane, point: [0, 0, 1$plane], normal: [0.$plane, 0.1, -1], material: Matte0 }"
    done
done
cat <<TAIL
  - { name: Far, type: plane, point: [0, 0, 10], normal: [0, 0, -1], material: Matte0 }
lights:
  - { type: point, position: [0, 5, 0], color: [1, 1, 1], power: 100 }
  - { type: quad, corner: [1, 5, -2], u: [-2, 0, 0], v: [0, 1, 2], power: 40 }
TAIL
