#ifndef VKWHITTED_SCENE_SPHERES_FILE_H
#define VKWHITTED_SCENE_SPHERES_FILE_H

#include "scene/npy.h"
#include "scene/scene.h"

/* Reads the spheres of the file that the mapping's key "file" names, as seen from the scene file's folder.
 * Reports what is wrong with it at that place; the object has no spheres then. */
void spheres_file_read(struct mapping *mapping, const struct npy_column columns[NPY_COLUMNS], size_t most,
                       struct scene_object *object);

#endif
