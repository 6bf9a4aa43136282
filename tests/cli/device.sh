. "$(dirname "$0")/lib.sh"

no_such_device() {
    for command in render check; do
        refused 2 '--device nosuch: ' $command $small --device nosuch "$figure"
        refused 2 '--device 99: ' $command $small --device 99 "$figure"
    done
    expect 2 "$VKWHITTED" devices --device nosuch
    said '^vkwhitted: error: --device nosuch: '
}

device_by_name() {
    name=$("$VKWHITTED" devices | sed -nE 's/^\* [0-9]+  ([^ (]+).*/\1/p')
    number=$("$VKWHITTED" devices | sed -nE 's/^\* ([0-9]+)  .*/\1/p')
    expect 0 "$VKWHITTED" render $small --device "$name" "$figure"
    said "on $name"
    expect 0 "$VKWHITTED" render $small --device "${name^^}" "$figure"
    expect 0 "$VKWHITTED" render $small --device "$number" "$figure"
}

no_devices_at_all() {
    export VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent
    for arguments in "render $small $figure -o a.png" "check $small $figure" devices; do
        expect 3 "$VKWHITTED" $arguments
        said '^vkwhitted: error: no Vulkan device found; .*mesa-vulkan-drivers'
    done
    expect 0 "$VKWHITTED" render $small "$figure" --backend cpu
    only_files
}

no_validation_layer() {
    mkdir empty
    export VK_LAYER_PATH=$PWD/empty
    refused 3 '--validate needs the layer VK_LAYER_KHRONOS_validation' check --validate $small "$figure"
    refused 3 '--validate needs the layer VK_LAYER_KHRONOS_validation' render --validate $small "$figure"
    expect 0 "$VKWHITTED" check $small "$figure"
}

devices() {
    expect 0 "$VKWHITTED" devices
    [ "$(grep -cE '^\* [0-9]+  ' out)" -eq 1 ] || fail 'not one device is chosen'
    for field in type driver Vulkan fp64 'storage buffer' 'uniform buffer'; do said "^      $field " out; done
    [ ! -s err ] || fail 'standard error'
}

"$1"
