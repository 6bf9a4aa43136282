# For the scripts here: SCRIPT.sh FUNCTION runs one test in a new folder. The environment names the programs:
# VKWHITTED, JSON_GET, and SOURCE_DIR.
set -u
export LC_ALL=C
figure=$SOURCE_DIR/scenes/figure_4.yaml
small='--size 60x40'
folder=$(mktemp -d) || exit 1
trap 'cd /; chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    echo "FAILED: $*" >&2
    for file in out err; do [ ! -s $file ] || sed "s/^/  $file: /" $file | head -20 >&2; done
    exit 1
}
skip() { echo "skipped: $*"; exit 77; }

# expect STATUS COMMAND...: runs it; standard output and error go to ./out and ./err.
expect() {
    local expected=$1 status
    shift
    "$@" >out 2>err
    status=$?
    [ "${SANITIZE-}" != ON ] || sed -i '/external symbolizer/d' err # of which clang 19 says that it is not installed
    [ $status -eq "$expected" ] || fail "exit status $status, expected $expected: $*"
}

# refused STATUS PATTERN ARGUMENTS...: the program ends so, says one line that matches, and nothing else.
refused() {
    local status=$1 pattern=$2
    shift 2
    expect "$status" "$VKWHITTED" "$@"
    [ ! -s out ] || fail "unexpected standard output of $*"
    [ "$(wc -l <err)" -eq 1 ] || fail "not one line from $*"
    grep -Eq -- "^vkwhitted: error: $pattern" err || fail "no message like '$pattern' from $*"
}

said() { grep -Eq -- "$1" "${2-err}" || fail "no '$1' in ${2-err}"; }
not_said() { ! grep -Eq -- "$1" "${2-err}" || fail "'$1' in ${2-err}"; }

# Wrong formulas: a file of shaders/, what is right, and what stands there instead. Oren-Nayar's B term by one part in
# 10000; Fresnel's k_r by a unit in the last place, everywhere or in the picture alone; total reflection too early; the
# end of shadow rays; normals by a unit in the last place; k_r and normals by one part in 10000.
declare -A formulas=(
    [term]='shade.glsl|(matte.a + matte.b * sin_tan)|(matte.a + matte.b * sin_tan * real(1.0001))'
    [k_r]='dielectric.glsl|return Refraction(total, reflectance,|return Refraction(total, intBitsToFloat(floatBitsToInt(reflectance) + 1),'
    [picture]='dielectric.glsl|return Refraction(total, reflectance,|#ifndef TRACE_EVENTS
reflectance = intBitsToFloat(floatBitsToInt(reflectance) + 1);
#endif
return Refraction(total, reflectance,'
    [total]='dielectric.glsl|total = !(cos_out_squared > real(0))|total = !(cos_out_squared > real(0.9))'
    [k_r_by_1e-4]='dielectric.glsl|exact real reflectance = (real(0.5) * (r_s * r_s))|exact real reflectance = (real(0.50005) * (r_s * r_s))'
    [normal_by_1e-4]='intersect.glsl|exact real3 normal = sphere ? sphere_normal : shape;|exact real3 normal = (sphere ? sphere_normal : shape) * real(1.0001);'
    [shadow]='intersect.glsl| && approach.along < distance|'
    [normal]='intersect.glsl|facing_normal = hit.from_inside ? -normal : normal|facing_normal = intBitsToFloat(floatBitsToInt(hit.from_inside ? -normal : normal) + 1)'
)
# break_shader NAME: makes the folder broken/NAME of shaders with that formula wrong.
break_shader() {
    local file=${formulas[$1]%%|*} change=${formulas[$1]#*|} text
    local right=${change%%|*} wrong=${change#*|}
    mkdir -p broken && cp -r "$SOURCE_DIR/shaders" "broken/$1"
    text=$(<"broken/$1/$file")
    [[ $text == *"$right"* ]] || fail "$file no longer has the formula that is to be broken"
    printf '%s\n' "${text/"$right"/"$wrong"}" >"broken/$1/$file"
}

# only_files NAME...: the folder holds these (and out, err) and nothing else, no left-over temporary.
only_files() {
    local found expected
    found=$(ls -A | grep -vx -e out -e err -e broken)
    expected=$(printf '%s\n' "$@" | sort)
    [ "$(sort <<<"$found")" = "$expected" ] || fail "files: $(tr '\n' ' ' <<<"$found"), expected: $*"
}

json() { "$JSON_GET" "$@" || fail "json_get $*"; }
# json_is VALUE FILE KEY...
json_is() { local expected=$1; shift; [ "$(json "$@")" = "$expected" ] || fail "$* is $(json "$@"), expected $expected"; }
