# Device against reference, in every bit, with the validation layer. The test's name says the parameters.
function(add_agreement name scene)
    add_test(NAME agreement/${name} COMMAND vkwhitted check --validate ${ARGN} ${scene})
    set_tests_properties(agreement/${name} PROPERTIES LABELS agreement TIMEOUT 300)
endfunction()

set(figures figure_2a figure_2b figure_3a figure_3b figure_3c figure_4)
if(VKWHITTED_SANITIZE)
    set(sizes 150x100 97x61)
    set(bounces 0 5 32)
    set(soft_light_samples 1 32)
    set(scene_size --size 150x100)
else()
    set(sizes 600x400 1920x1080 333x217)
    set(bounces 0 1 5 32)
    set(soft_light_samples 1 32 256)
    set(scene_size)
endif()

foreach(figure IN LISTS figures)
    set(scene ${PROJECT_SOURCE_DIR}/scenes/${figure}.yaml)
    foreach(size IN LISTS sizes)
        foreach(bounce IN LISTS bounces)
            add_agreement(${figure}/${size}/bounces_${bounce} ${scene} --size ${size} --max-bounces ${bounce})
        endforeach()
    endforeach()
    add_agreement(${figure}/120x80/samples_4 ${scene} --size 120x80 --samples 4)
endforeach()
foreach(count IN LISTS soft_light_samples)
    add_agreement(figure_2b/120x80/light_samples_${count} ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
                  --size 120x80 --light-samples ${count})
endforeach()
add_agreement(figure_2b/120x80/samples_4_light_samples_7 ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
              --size 120x80 --samples 4 --light-samples 7)

# Scenes that provoke; each says what.
file(GLOB scenes CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/scenes/*.yaml)
foreach(scene IN LISTS scenes)
    cmake_path(GET scene STEM name)
    add_agreement(${name} ${scene} ${scene_size})
    add_agreement(${name}/97x61/bounces_14 ${scene} --size 97x61 --max-bounces 14)
    add_agreement(${name}/120x80/samples_3_light_samples_5 ${scene} --size 120x80 --samples 3 --light-samples 5)
endforeach()

function(add_scattered count)
    execute_process(COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scenes/scatter_spheres.sh ${count}
                    OUTPUT_FILE ${CMAKE_CURRENT_BINARY_DIR}/scatter_${count}.yaml COMMAND_ERROR_IS_FATAL ANY)
    add_agreement(scatter_${count} ${CMAKE_CURRENT_BINARY_DIR}/scatter_${count}.yaml -q ${ARGN})
    add_agreement(scatter_${count}/80x53/samples_2 ${CMAKE_CURRENT_BINARY_DIR}/scatter_${count}.yaml -q
                  --size 80x53 --samples 2 ${ARGN})
endfunction()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS scenes/scatter_spheres.sh)
add_scattered(10)
add_scattered(30)
add_scattered(300)
add_scattered(1100 --max-bounces 1 --light-samples 1)

# Lavapipe ends all loops of an invocation after 65535 turns, counted together (Mesa's LP_MAX_TGSI_LOOP_ITERATIONS),
# without a word: what takes more has to be cut up.
add_agreement(many_turns/figure_2b/64x40/light_samples_8192 ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
              --size 64x40 --light-samples 8192)
add_agreement(many_turns/figure_2b/64x40/samples_256 ${PROJECT_SOURCE_DIR}/scenes/figure_2b.yaml
              --size 64x40 --samples 256)
add_agreement(many_turns/overlapping_glass/120x80/bounces_32
              ${CMAKE_CURRENT_SOURCE_DIR}/scenes/overlapping_glass.yaml --size 120x80 --max-bounces 32)
add_agreement(many_turns/ten_hostile/light_samples_9000 ${CMAKE_CURRENT_SOURCE_DIR}/scenes/ten_hostile.yaml -q
              --light-samples 9000)
# Up to 400000 rays in a pixel: one sample takes several dispatches.
foreach(arguments "" "--precision;double" "--samples;2" "--max-error;1e-12")
    string(MAKE_C_IDENTIFIER "${arguments}" name)
    add_agreement(many_turns/diamond/30x20/bounces_64${name} ${PROJECT_SOURCE_DIR}/scenes/hard/diamond.yaml
                  --size 30x20 --max-bounces 64 ${arguments})
endforeach()
add_agreement(many_turns/touching/120x80/bounces_64 ${PROJECT_SOURCE_DIR}/scenes/hard/touching.yaml
              --size 120x80 --max-bounces 64)
