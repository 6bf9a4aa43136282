# For the scripts here: SCRIPT.sh FUNCTION runs one test in a new folder. The environment names the programs:
# VKWHITTED, BROKEN (whose shader has one wrong formula), JSON_GET, and SOURCE_DIR.
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

# only_files NAME...: the folder holds these (and out, err) and nothing else, no left-over temporary.
only_files() {
    local found expected
    found=$(ls -A | grep -vx -e out -e err)
    expected=$(printf '%s\n' "$@" | sort)
    [ "$(sort <<<"$found")" = "$expected" ] || fail "files: $(tr '\n' ' ' <<<"$found"), expected: $*"
}

json() { "$JSON_GET" "$@" || fail "json_get $*"; }
