# Device against reference, in every bit, with the validation layer. The test's name says the parameters. Sizes are no
# multiples of a group of invocations, so that every picture has groups that stick out of it.
function(add_agreement name scene)
    add_test(NAME agreement/${name} COMMAND vkwhitted check --validate ${ARGN} ${scene})
    set_tests_properties(agreement/${name} PROPERTIES LABELS agreement TIMEOUT 300)
endfunction()

foreach(scene IN LISTS figure_scenes)
    cmake_path(GET scene STEM name)
    add_agreement(${name}/97x61 ${scene} --size 97x61)
endforeach()

add_agreement(figure_2b/60x40/samples_4_light_samples_7 ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
              --size 60x40 --samples 4 --light-samples 7)
add_agreement(many_turns/diamond/30x20/bounces_64 ${PROJECT_SOURCE_DIR}/scenes/hard/diamond.yaml
              --size 30x20 --max-bounces 64)
if(VKWHITTED_TESTS STREQUAL "memory")
    return()
endif()

# A stack of 14 is memory, one of 5 is registers. From 2^17 pixels on lavapipe gets primary rays first.
add_agreement(hard/97x61/bounces_14 "${hard_scenes}" -q --size 97x61 --max-bounces 14)
add_agreement(tests/97x61/bounces_14 "${test_scenes}" -q --size 97x61 --max-bounces 14)
if(VKWHITTED_SLOW_TESTS)
    set(samples_scenes ${test_scenes})
else() # those with most of everything
    set(samples_scenes ${test_scenes})
    list(FILTER samples_scenes INCLUDE REGEX "/(glass_half_space|ten_hostile|ten_lights|ties)\\.yaml$")
endif()
foreach(scene IN LISTS samples_scenes)
    cmake_path(GET scene STEM name)
    add_agreement(${name}/60x40/samples_3_light_samples_5 ${scene} --size 60x40 --samples 3 --light-samples 5)
endforeach()
if(VKWHITTED_SLOW_TESTS)
    set(large_scenes ${hard_scenes})
else()
    set(large_scenes ${hard_scenes})
    list(FILTER large_scenes INCLUDE REGEX "/(bubble|diamond|facing_mirrors|ground_sphere|touching|thin_shell)\\.yaml$")
endif()
add_agreement(hard/417x323 "${large_scenes}" -q --size 417x323)
add_agreement(figures/417x323/bounces_5 "${figure_scenes}" -q --size 417x323 --max-bounces 5)
add_agreement(figures/97x61/samples_4 "${figure_scenes}" -q --size 97x61 --samples 4)
foreach(count 1 32 256)
    add_agreement(figure_2b/97x61/light_samples_${count} ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
                  --size 97x61 --light-samples ${count})
endforeach()
# More than 2^21 pixels take two dispatches.
add_agreement(figure_4/2051x1033 ${PROJECT_SOURCE_DIR}/scenes/figure_4.yaml --size 2051x1033)

add_agreement(sphereflake/97x61 ${PROJECT_SOURCE_DIR}/scenes/sphereflake.yaml --size 97x61)

function(add_scattered count)
    execute_process(COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scenes/scatter_spheres.sh ${count}
                    OUTPUT_FILE ${CMAKE_CURRENT_BINARY_DIR}/scatter_${count}.yaml COMMAND_ERROR_IS_FATAL ANY)
    add_agreement(scatter_${count}/97x61 ${CMAKE_CURRENT_BINARY_DIR}/scatter_${count}.yaml -q --size 97x61 ${ARGN})
endfunction()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS scenes/scatter_spheres.sh)
add_scattered(10)
add_scattered(30)
add_scattered(1100 --max-bounces 1 --light-samples 1 --samples 2)

# Lavapipe ends all loops of an invocation after 65535 turns, counted together (Mesa's LP_MAX_TGSI_LOOP_ITERATIONS),
# without a word: what takes more has to be cut up.
add_agreement(many_turns/figure_2b/33x21/light_samples_8192 ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
              --size 33x21 --light-samples 8192)
add_agreement(many_turns/figure_2b/4x4/light_samples_65536 ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
              --size 4x4 --light-samples 65536)
add_agreement(many_turns/figure_2b/33x21/samples_256 ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
              --size 33x21 --samples 256)
add_agreement(many_turns/overlapping_glass/60x40/bounces_32
              ${CMAKE_CURRENT_SOURCE_DIR}/scenes/overlapping_glass.yaml --size 60x40 --max-bounces 32)
add_agreement(many_turns/crowded_glass/512x32/samples_8 ${CMAKE_CURRENT_SOURCE_DIR}/scenes/crowded_glass.yaml -q
              --size 512x32 --samples 8) # so many samples that primary rays come first
add_agreement(many_turns/ten_hostile/16x8/light_samples_9000 ${CMAKE_CURRENT_SOURCE_DIR}/scenes/ten_hostile.yaml -q
              --size 16x8 --light-samples 9000)
# Up to 400000 rays in a pixel: one sample takes several dispatches.
foreach(arguments "--precision;double" "--samples;2" "--max-error;1e-12")
    string(MAKE_C_IDENTIFIER "${arguments}" name)
    add_agreement(many_turns/diamond/30x20/bounces_64${name} ${PROJECT_SOURCE_DIR}/scenes/hard/diamond.yaml
                  --size 30x20 --max-bounces 64 ${arguments})
endforeach()
add_agreement(many_turns/touching/120x80/bounces_64 ${PROJECT_SOURCE_DIR}/scenes/hard/touching.yaml
              --size 120x80 --max-bounces 64) # in tiles of 4096 pixels
add_agreement(many_turns/figure_4/600x400/bounces_1000 ${PROJECT_SOURCE_DIR}/scenes/figure_4.yaml --size 600x400
              --max-bounces 1000 --max-error 1e-3 --validate) # whose stacks need smaller tiles
