# unit/compiler looks at the arithmetic of the shaders; here, whether a driver may read them.
find_program(SPIRV_VAL spirv-val REQUIRED)
add_test(NAME shader/valid COMMAND sh -c "for module in \"$1\"/*.spv; do \"$0\" --target-env vulkan1.2 \"$module\" || exit; done"
                                   ${SPIRV_VAL} ${PROJECT_BINARY_DIR}/shaders)
set_tests_properties(shader/valid PROPERTIES LABELS shader TIMEOUT 120)
