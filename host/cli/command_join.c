#include "cli/options.h"

#include "image/join.h"

enum status command_join(const struct options *options)
{
    struct join *join;
    enum status status = join_create((const char *const *)options->scenes, options->scene_count, &join);
    if (status != STATUS_DONE)
        return status;
    const struct image_rows rows = join_rows(join);
    struct image_metadata metadata = join_metadata(join);
    metadata.transfer = options->transfer;
    for (size_t i = 0; i < options->output_count; ++i)
        status = status_worse(status, image_write_rows(&rows, options->outputs[i], &metadata));
    if (status == STATUS_DONE)
        log_notice("%ux%u from %zu tiles", rows.width, rows.height, options->scene_count);
    join_destroy(&join);
    return status;
}
