# The same bits elsewhere: the reference as other compilers and another architecture build it, the shader as an
# unrelated driver runs it.
function(find_for_elsewhere variable)
    find_program(${variable} ${ARGN})
    if(NOT ${variable})
        message(FATAL_ERROR "VKWHITTED_TEST_ELSEWHERE needs ${ARGN}, which is not installed: ./bootstrap --test "
                            "installs it, -D VKWHITTED_TEST_ELSEWHERE=OFF leaves these tests out")
    endif()
endfunction()
find_for_elsewhere(VKWHITTED_GCC gcc)
find_for_elsewhere(VKWHITTED_CLANG clang)
find_for_elsewhere(VKWHITTED_AARCH64_GCC aarch64-linux-gnu-gcc)
find_for_elsewhere(VKWHITTED_QEMU_AARCH64 qemu-aarch64)
find_file(VKWHITTED_SWIFTSHADER_ICD vk_swiftshader_icd.json
          PATHS /usr/lib/chromium /usr/lib64/chromium /usr/lib64/chromium-browser
          DOC "Vulkan driver manifest of SwiftShader")
if(NOT VKWHITTED_SWIFTSHADER_ICD)
    message(FATAL_ERROR "VKWHITTED_TEST_ELSEWHERE needs vk_swiftshader_icd.json, which Debian's package chromium has: "
                        "./bootstrap --test installs it, -D VKWHITTED_SWIFTSHADER_ICD=FILE says where it is, "
                        "-D VKWHITTED_TEST_ELSEWHERE=OFF leaves these tests out")
endif()

# What this build makes of the scenes is what all others must make of them.
add_executable(pack_scenes reference_bits/pack_scenes.c)
target_link_libraries(pack_scenes PRIVATE vkwhitted_host)
add_executable(reference_bits reference_bits/reference_bits.c)
target_link_libraries(reference_bits PRIVATE reference)
set(few_spheres ${figure_scenes} ${hard_scenes} ${test_scenes})
list(FILTER few_spheres EXCLUDE REGEX "sphere_decades|coincident_spheres|spheres_in_a_plane|camera_in_cloud|giant_and_grains")
set(packed_scenes ${CMAKE_CURRENT_BINARY_DIR}/reference_bits_scenes)
set(expected_bits ${CMAKE_CURRENT_BINARY_DIR}/reference_bits_expected)
add_test(NAME elsewhere/pack_scenes
         COMMAND pack_scenes ${packed_scenes} 15x10 ${few_spheres})
add_test(NAME elsewhere/reference_bits COMMAND sh -c "\"$0\" \"$1\" >\"$2\" && test -s \"$2\""
                                               $<TARGET_FILE:reference_bits> ${packed_scenes} ${expected_bits})
set_tests_properties(elsewhere/pack_scenes PROPERTIES LABELS elsewhere FIXTURES_SETUP packed_scenes)
set_tests_properties(elsewhere/reference_bits PROPERTIES LABELS elsewhere FIXTURES_REQUIRED packed_scenes
                     FIXTURES_SETUP reference_bits)

set(reference ${PROJECT_SOURCE_DIR}/cpu_reference)
file(GLOB reference_parts CONFIGURE_DEPENDS ${reference}/*.[ch] ${PROJECT_SOURCE_DIR}/shaders/*.h)
set(compile_reference -std=c17 -ffp-contract=off -D_GNU_SOURCE -I${reference} -I${PROJECT_SOURCE_DIR}/shaders -c)

# Further arguments: compiler and options. `emulator` may be set.
function(add_reference_build name)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/reference_bits_${name})
    set(program ${folder}/reference_bits)
    file(MAKE_DIRECTORY ${folder})
    set(compile_all)
    set(objects)
    foreach(precision bits IN ZIP_LISTS precisions precision_bits)
        foreach(part tracer explain)
            if(NOT "${precision} ${part}" STREQUAL "float explain")
                list(APPEND compile_all COMMAND ${ARGN} ${compile_reference} -DREFERENCE_BITS=${bits}
                     -DREFERENCE_TRACE=reference_trace_${precision} -DREFERENCE_EXPLAIN=reference_explain_${precision}
                     ${reference}/${part}.c -o ${folder}/${part}_${precision}.o)
                list(APPEND objects ${folder}/${part}_${precision}.o)
            endif()
        endforeach()
    endforeach()
    add_custom_command(
        OUTPUT ${program}
        ${compile_all}
        COMMAND ${ARGN} ${compile_reference} ${CMAKE_CURRENT_SOURCE_DIR}/reference_bits/reference_bits.c
                -o ${folder}/reference_bits.o
        COMMAND ${ARGN} ${compile_reference} ${reference}/sphere_tree.c -o ${folder}/sphere_tree.o
        COMMAND ${ARGN} ${objects} ${folder}/sphere_tree.o ${folder}/reference_bits.o -lm -o ${program}
        DEPENDS ${reference_parts} reference_bits/reference_bits.c reference_bits/scene_bytes.h
        COMMENT "Building the reference: ${name}"
        VERBATIM)
    set(programs ${programs} ${program} PARENT_SCOPE)
    add_test(NAME elsewhere/reference_bits/${name}
             COMMAND sh -c "expected=$1; shift; \"$@\" >\"$0\" && diff \"$expected\" \"$0\"" ${folder}/bits
                     ${expected_bits} ${emulator} ${program} ${packed_scenes})
    set_tests_properties(elsewhere/reference_bits/${name} PROPERTIES LABELS elsewhere TIMEOUT 600
                         FIXTURES_REQUIRED "packed_scenes;reference_bits")
endfunction()

set(precisions float double quad)
set(precision_bits 32 64 128)
set(emulator)
add_reference_build(gcc_O3_native ${VKWHITTED_GCC} -O3 -march=native)
add_reference_build(clang_O3_native ${VKWHITTED_CLANG} -O3 -march=native)
set(emulator ${VKWHITTED_QEMU_AARCH64})
if(VKWHITTED_SLOW_TESTS)
    add_reference_build(aarch64_gcc_O0 ${VKWHITTED_AARCH64_GCC} -O0 -static)
    add_reference_build(aarch64_clang_O3 ${VKWHITTED_CLANG} --target=aarch64-linux-gnu -O3 -static)
endif()
add_reference_build(aarch64_gcc_O3 ${VKWHITTED_AARCH64_GCC} -O3 -static)
add_custom_target(reference_builds ALL DEPENDS ${programs})

# SwiftShader takes 20 s to compile a pipeline.
set(swiftshader VK_ICD_FILENAMES=${VKWHITTED_SWIFTSHADER_ICD} VK_DRIVER_FILES=${VKWHITTED_SWIFTSHADER_ICD})
function(add_swiftshader_test name)
    add_test(NAME elsewhere/swiftshader/${name} COMMAND vkwhitted ${ARGN})
    set_tests_properties(elsewhere/swiftshader/${name} PROPERTIES LABELS elsewhere TIMEOUT 900
                         ENVIRONMENT "${swiftshader}")
endfunction()
add_swiftshader_test(devices devices)
set_tests_properties(elsewhere/swiftshader/devices PROPERTIES PASS_REGULAR_EXPRESSION "\\* 0  SwiftShader")
if(VKWHITTED_SLOW_TESTS)
    foreach(scene IN LISTS figure_scenes hard_scenes)
        cmake_path(GET scene STEM name)
        add_swiftshader_test(${name}/60x40 check --size 60x40 ${scene})
    endforeach()
endif()
# Tiles of lavapipe, SwiftShader and the reference make one picture.
add_test(NAME elsewhere/swiftshader/join COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/cli/join.sh drivers)
set_tests_properties(
    elsewhere/swiftshader/join
    PROPERTIES LABELS elsewhere TIMEOUT 900
               ENVIRONMENT "VKWHITTED=$<TARGET_FILE:vkwhitted>;SOURCE_DIR=${PROJECT_SOURCE_DIR};\
SWIFTSHADER=${VKWHITTED_SWIFTSHADER_ICD}")
