# What the compiler was told about the shaders' arithmetic.
find_program(SPIRV_DIS spirv-dis REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)
foreach(module whitted_exact whitted_exact_storage whitted_corrected whitted_corrected_storage
        whitted_exact_events whitted_exact_events_storage whitted_corrected_events whitted_corrected_events_storage)
    add_test(NAME shader/${module}/no_contraction
             COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/check_spirv.sh ${PROJECT_BINARY_DIR}/shaders/${module}.spv)
    set_tests_properties(shader/${module}/no_contraction PROPERTIES LABELS shader TIMEOUT 60)
endforeach()
foreach(module whitted_fast whitted_fast_storage)
    add_test(NAME shader/${module}/valid
             COMMAND ${SPIRV_VAL} --target-env vulkan1.2 ${PROJECT_BINARY_DIR}/shaders/${module}.spv)
    set_tests_properties(shader/${module}/valid PROPERTIES LABELS shader TIMEOUT 60)
endforeach()
