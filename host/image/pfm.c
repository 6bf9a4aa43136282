#include <stdio.h>

#include "base/output_file.h"
#include "image/formats.h"

/* The sign of the scale says the byte order: negative is little-endian. Rows run from bottom to top.
 * Paul Debevec's PFM format: https://www.pauldebevec.com/Research/HDR/PFM/ */
static const char *const scale = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "-1.0" : "1.0";

enum status image_write_pfm(const struct image *image, const char *path,
                            const struct image_metadata *metadata)
{
    (void)metadata;
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;

    fprintf(file.stream, "PF\n%u %u\n%s\n", image->width, image->height, scale); /* is buffered */
    size_t row_channels = (size_t)image->width * 3;
    for (unsigned y = image->height; y-- > 0;)
        output_file_write(&file, image->rgb + y * row_channels, row_channels * sizeof(float));
    return output_file_commit(&file);
}
