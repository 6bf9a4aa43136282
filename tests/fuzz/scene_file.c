#include <stdlib.h>

#include "fuzz.h"
#include "scene/scene.h"

/* The text of a scene file. */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct scene scene;
    enum status status = scene_read_text("fuzz.yaml", (const char *)data, size, &scene);
    if (status == STATUS_DONE && (scene.width == 0 || scene.height == 0 || !scene.path))
        abort();
    for (size_t i = 0; i < scene.object_count; i++)
        if (scene.objects[i].material >= scene.material_count || !scene.objects[i].name)
            abort();
    if (status != STATUS_DONE && (scene.path || scene.materials || scene.objects || scene.lights))
        abort();
    scene_destroy(&scene);
    return 0;
}
