. "$(dirname "$0")/lib.sh"

# A Debian package of the build, installed into a tree that holds nothing else, used there, and removed.

as_root=
[ "$(id -u)" -eq 0 ] || as_root='unshare --map-root-user'
in_tree() { $as_root dpkg --root="$PWD/tree" --force-depends --log=/dev/null "$@"; }
found() { (cd tree && find . -path ./var/lib/dpkg -prune -o -print | sort); }

deb() {
    expect 0 cpack -G DEB --config "$BINARY_DIR/CPackConfig.cmake" -B made
    local package=$(echo made/*.deb)
    for needed in libc6 libfyaml0 libgl1 libglfw3 libgomp1 libjansson4 libopenexr libpng16 libvulkan1; do
        dpkg-deb -f "$package" Depends | grep -q "$needed" || fail "$needed is not among the dependencies"
    done
    if command -v lintian >/dev/null; then # more than a hundred packages
        expect 0 lintian --allow-root --fail-on error "$package"
    fi
    mkdir -p tree/var/lib/dpkg/info tree/var/lib/dpkg/updates tree/var/lib/dpkg/triggers
    touch tree/var/lib/dpkg/status
    found >before
    expect 0 in_tree --install "$package"
    local program=$PWD/tree/usr/bin/vkwhitted share=$PWD/tree/usr/share
    expect 0 "$program" render $small figure_4 -o a.pfm
    said "^vkwhitted: $share/vkwhitted/scenes/figure_4.yaml: 60x40 in "
    expect 0 "$VKWHITTED" render $small "$figure" -o expected.pfm
    cmp a.pfm expected.pfm || fail 'another picture'
    expect 0 "$program" check $small hard/camera_in_cloud --shaders "$share/vkwhitted/shaders"
    diff -r "$SOURCE_DIR/shaders" "$share/vkwhitted/shaders" | grep -v 'CMakeLists.txt$' && fail 'the shaders'
    gzip -dc "$share/man/man1/vkwhitted.1.gz" | cmp - "$BINARY_DIR/vkwhitted.1" || fail 'the manual page'
    cmp "$share/bash-completion/completions/vkwhitted" "$BINARY_DIR/completions/bash/vkwhitted" || fail 'bash'
    cmp "$share/zsh/vendor-completions/_vkwhitted" "$BINARY_DIR/completions/zsh/_vkwhitted" || fail 'zsh'
    grep -o ']([a-zA-Z_/0-9.]*' "$share/doc/vkwhitted/README.md" "$share/doc/vkwhitted/CONTRIBUTING.md" |
        sed 's/.*](//' | while read -r link; do
        [ -z "$link" ] || [ -e "$share/doc/vkwhitted/$link" ] || [ "$link" = LICENSE ] || fail "no $link in the documents"
    done || exit 1
    expect 0 in_tree --purge vkwhitted
    found | diff before - || fail 'something is left'
}

"$1"
