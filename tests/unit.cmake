# One executable a module: unit_MODULE.c. Further arguments are libraries.
function(add_unit_test module)
    add_executable(unit_${module} unit_${module}.c)
    target_include_directories(unit_${module} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
    target_compile_definitions(unit_${module} PRIVATE SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    target_link_libraries(unit_${module} PRIVATE vkwhitted_host PkgConfig::cmocka ${ARGN})
    add_test(NAME unit/${module} COMMAND unit_${module})
    set_tests_properties(unit/${module} PROPERTIES LABELS unit TIMEOUT 120)
endfunction()

add_unit_test(bench)
target_link_options(unit_bench PRIVATE -Wl,--wrap=calloc,--wrap=malloc) # to have them fail
add_unit_test(camera_motion)
add_unit_test(compare)
add_unit_test(fit)
add_unit_test(image)
add_unit_test(number)
add_unit_test(pack)
add_unit_test(output_file)
add_unit_test(progress)
add_unit_test(scene_file)
add_unit_test(inputs)
add_unit_test(compiler)
target_compile_definitions(unit_compiler PRIVATE SHADER_DEBUG_INFO=$<BOOL:${VKWHITTED_SHADER_DEBUG_INFO}>)
add_unit_test(srgb)
add_unit_test(warnings)
add_unit_test(text_file)

# These open a device. The dear ones, with the same bits in all builds, run in one.
set(device_modules pixel tracer)
if(VKWHITTED_TESTS STREQUAL "all")
    add_unit_test(convergence)
    list(APPEND device_modules properties total_reflection truncation values)
endif()
foreach(module IN LISTS device_modules)
    add_unit_test(${module})
    set_tests_properties(unit/${module} PROPERTIES LABELS "unit;device" TIMEOUT 600)
endforeach()
target_link_options(unit_tracer PRIVATE LINKER:--wrap=vkCreateComputePipelines) # which the test makes fail

if(CMAKE_C_COMPILER_ID MATCHES Clang AND NOT VKWHITTED_SANITIZE)
    # The host library is compiled a second time, for libFuzzer's counters.
    file(GLOB host_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/host/base/*.c ${PROJECT_SOURCE_DIR}/host/scene/*.c)
    add_executable(fuzz_scene_file fuzz_scene_file.c ${host_sources})
    target_include_directories(fuzz_scene_file PRIVATE ${PROJECT_SOURCE_DIR}/host)
    target_compile_options(fuzz_scene_file PRIVATE -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all)
    target_link_options(fuzz_scene_file PRIVATE -fsanitize=fuzzer,address,undefined)
    target_link_libraries(fuzz_scene_file PRIVATE scene_layout PkgConfig::jansson PkgConfig::libfyaml m)
    file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/fuzz_corpus)
    add_test(NAME unit/fuzz_scene_file/20000_runs
             COMMAND fuzz_scene_file -runs=20000 -seed=1 -close_fd_mask=2
                     ${CMAKE_CURRENT_BINARY_DIR}/fuzz_corpus ${PROJECT_SOURCE_DIR}/scenes)
    set_tests_properties(unit/fuzz_scene_file/20000_runs PROPERTIES LABELS unit TIMEOUT 300)
endif()
