#ifndef VKWHITTED_CLI_SCENE_NAME_H
#define VKWHITTED_CLI_SCENE_NAME_H

/* The path of the scene of that name, figure_4 or hard/diamond, among those that came with the program, where
 * there is no file at that path; to be freed by the caller. NULL: that is no such name, or there is no
 * memory. */
char *scene_name_find(const char *name);

/* What a command may be given: "a scene file, or one of the program's: figure_2a, ..."; to be freed by the
 * caller. NULL without memory. */
char *scene_name_list(void);

#endif
