#ifndef VKWHITTED_WATCH_SHADER_FOLDER_H
#define VKWHITTED_WATCH_SHADER_FOLDER_H

/* The path of whitted.comp in the folder, or where that is NULL, in the folder that was installed with the
 * program or, for a program that is not installed, in the source tree. The caller frees it; NULL (reported)
 * without memory. */
char *shader_file_path(const char *folder);

#endif
