#include "scene/yaml.h"

#include <errno.h>
#include <libfyaml.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

enum {
    MAX_DEPTH = 16, /* a scene needs 5 */
    MAX_ANCHORS = 100,
    BLOCK_SIZE = 1 << 16, /* bytes */
};

struct yaml_block {
    struct yaml_block *next;
    size_t used, size;
    max_align_t bytes[];
};

struct anchor {
    const char *name;
    size_t length;
    const struct yaml_node *node; /* NULL as long as the node is open: nothing can contain itself */
};

struct open_collection {
    struct yaml_node *node;
    struct yaml_node *last; /* the child added last */
    struct anchor *anchor;
};

struct builder {
    struct diagnostics *report;
    struct yaml_tree *tree;
    struct scene_place place; /* of the latest event that has one */
    size_t document_count, depth, anchor_count;
    struct open_collection open[MAX_DEPTH];
    struct anchor anchors[MAX_ANCHORS];
    bool ended; /* the end of the stream was seen, or the rest does not matter */
};

static void *tree_alloc(struct builder *builder, size_t size)
{
    struct yaml_block *block = builder->tree->blocks;
    size = (size + sizeof(max_align_t) - 1) / sizeof(max_align_t) * sizeof(max_align_t);
    if (!block || block->size - block->used < size) {
        size_t room = size > BLOCK_SIZE ? size : BLOCK_SIZE;
        block = malloc(sizeof(*block) + room);
        if (!block) {
            builder->report->no_memory = true;
            return NULL;
        }
        *block = (struct yaml_block){.next = builder->tree->blocks, .size = room};
        builder->tree->blocks = block;
    }
    void *memory = (char *)block->bytes + block->used;
    block->used += size;
    return memory;
}

void yaml_free(struct yaml_tree *tree)
{
    while (tree->blocks) {
        struct yaml_block *next = tree->blocks->next;
        free(tree->blocks);
        tree->blocks = next;
    }
    tree->root = NULL;
}

bool yaml_is_empty(const struct yaml_node *node)
{
    return node->type == YAML_SCALAR && node->plain && node->length == 0;
}

/* Copies the token's text to copy, if that is not NULL, and returns its length in bytes; -1 without memory.
 * In pieces, because fy_token_get_text() of libfyaml 0.7.12 leaks memory where a scalar has many escapes. */
static ssize_t gather_text(struct fy_token *token, char *copy)
{
    struct fy_token_iter *pieces = fy_token_iter_create(token);
    if (!pieces)
        return -1;
    size_t length = 0;
    int error = 0;
    const struct fy_iter_chunk *piece = fy_token_iter_chunk_next(pieces, NULL, &error);
    while (piece) {
        if (copy)
            memcpy(copy + length, piece->str, piece->len);
        length += piece->len;
        piece = fy_token_iter_chunk_next(pieces, piece, &error);
    }
    fy_token_iter_destroy(pieces);
    return error ? -1 : (ssize_t)length;
}

/* The token's text, copied into the tree; NULL where there is no memory. */
static const char *copy_text(struct builder *builder, struct fy_token *token, size_t *length)
{
    ssize_t size = token ? gather_text(token, NULL) : 0;
    char *copy = size < 0 ? NULL : tree_alloc(builder, (size_t)size + 1);
    *length = 0;
    if (!copy || (token && gather_text(token, copy) != size)) {
        builder->report->no_memory = true;
        return NULL;
    }
    *length = (size_t)size;
    copy[size] = '\0';
    return copy;
}

/* Puts the node behind its elder siblings, or at the root. */
static void attach(struct builder *builder, struct yaml_node *node)
{
    if (builder->depth == 0) {
        builder->tree->root = node;
        return;
    }
    struct open_collection *parent = &builder->open[builder->depth - 1];
    if (parent->last)
        parent->last->next = node;
    else
        parent->node->child = node;
    parent->last = node;
    parent->node->count++;
}

static struct yaml_node *add_node(struct builder *builder, enum yaml_type type)
{
    struct yaml_node *node = tree_alloc(builder, sizeof(*node));
    if (!node)
        return NULL;
    *node = (struct yaml_node){.type = type, .place = builder->place};
    attach(builder, node);
    return node;
}

static struct anchor *add_anchor(struct builder *builder, struct fy_token *token)
{
    if (!token)
        return NULL;
    if (builder->anchor_count == MAX_ANCHORS) {
        report_error(builder->report, builder->place, "more than %d anchors", MAX_ANCHORS);
        builder->ended = true;
        return NULL;
    }
    struct anchor *anchor = &builder->anchors[builder->anchor_count];
    *anchor = (struct anchor){0};
    anchor->name = copy_text(builder, token, &anchor->length);
    if (!anchor->name)
        return NULL;
    builder->anchor_count++;
    return anchor;
}

static void refuse_tag(struct builder *builder, struct fy_token *tag, struct yaml_node *node)
{
    if (!tag)
        return;
    const struct fy_mark *mark = fy_token_start_mark(tag);
    struct scene_place place = mark ? (struct scene_place){mark->line + 1, mark->column + 1} : builder->place;
    report_error(builder->report, place, "scene files have no YAML tags (\"!...\")");
    node->type = YAML_BROKEN;
}

/* libfyaml 0.7.12 makes 3 quotes of the 2 in 'a''''b'. */
static void refuse_quotes(struct builder *builder, struct yaml_node *node)
{
    report_error(builder->report, node->place, "quotes in a row: this text needs double quotes around it");
    node->type = YAML_BROKEN;
}

static void add_scalar(struct builder *builder, struct fy_event_scalar_data *scalar)
{
    struct anchor *anchor = add_anchor(builder, scalar->anchor);
    struct yaml_node *node = add_node(builder, YAML_SCALAR);
    if (!node)
        return;
    node->text = copy_text(builder, scalar->value, &node->length);
    enum fy_scalar_style style = fy_token_scalar_style(scalar->value);
    node->plain = style == FYSS_PLAIN || style == FYSS_ANY;
    if (style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED)
        node->place.column--; /* libfyaml's mark stands behind the quote */
    refuse_tag(builder, scalar->tag, node);
    if (style == FYSS_SINGLE_QUOTED && node->text && strstr(node->text, "''"))
        refuse_quotes(builder, node);
    if (anchor)
        anchor->node = node;
}

/* The latest one of that name, or NULL. */
static const struct anchor *find_anchor(const struct builder *builder, const char *name, size_t length)
{
    for (size_t i = builder->anchor_count; i-- > 0;) {
        const struct anchor *anchor = &builder->anchors[i];
        if (anchor->length == length && memcmp(anchor->name, name, length) == 0)
            return anchor;
    }
    return NULL;
}

static void add_alias(struct builder *builder, struct fy_token *token)
{
    size_t length;
    const char *name = copy_text(builder, token, &length);
    struct yaml_node *node = add_node(builder, YAML_BROKEN);
    if (!name || !node)
        return;
    const struct anchor *anchor = find_anchor(builder, name, length);
    if (!anchor || !anchor->node) {
        char quote[REPORT_QUOTE_SIZE];
        report_error(builder->report, builder->place, "alias %s: no such anchor before it",
                     report_quote(name, length, quote));
        return;
    }
    *node = *anchor->node;
    node->place = builder->place;
    node->next = NULL;
}

static void open_collection(struct builder *builder, enum yaml_type type, struct fy_token *anchor_token,
                            struct fy_token *tag)
{
    struct anchor *anchor = add_anchor(builder, anchor_token);
    struct yaml_node *node = add_node(builder, type);
    if (!node)
        return;
    refuse_tag(builder, tag, node);
    if (builder->depth == MAX_DEPTH) {
        report_error(builder->report, builder->place, "nested more than %d deep", MAX_DEPTH);
        builder->ended = true;
        builder->tree->root = NULL;
        return;
    }
    builder->open[builder->depth++] = (struct open_collection){.node = node, .anchor = anchor};
}

static void close_collection(struct builder *builder)
{
    struct open_collection *closed = &builder->open[--builder->depth];
    if (closed->anchor)
        closed->anchor->node = closed->node;
}

static void add_event(struct builder *builder, struct fy_event *event)
{
    const struct fy_mark *mark = event->type == FYET_STREAM_END ? NULL : fy_event_start_mark(event);
    if (mark)
        builder->place = (struct scene_place){mark->line + 1, mark->column + 1};
    builder->document_count += event->type == FYET_DOCUMENT_START;
    if (builder->document_count > 1 && (mark || event->type != FYET_DOCUMENT_START)) {
        report_error(builder->report, builder->place, "a second document; a scene file must hold one");
        builder->ended = true;
        return;
    }
    switch (event->type) {
    case FYET_SCALAR:
        add_scalar(builder, &event->scalar);
        break;
    case FYET_ALIAS:
        builder->place.column--; /* libfyaml's mark stands behind the asterisk */
        add_alias(builder, event->alias.anchor);
        break;
    case FYET_SEQUENCE_START:
        open_collection(builder, YAML_SEQUENCE, event->sequence_start.anchor, event->sequence_start.tag);
        break;
    case FYET_MAPPING_START:
        open_collection(builder, YAML_MAPPING, event->mapping_start.anchor, event->mapping_start.tag);
        break;
    case FYET_SEQUENCE_END:
    case FYET_MAPPING_END:
        close_collection(builder);
        break;
    case FYET_STREAM_END:
        builder->ended = true;
        break;
    default:
        break;
    }
}

/* Bytes of the character at text that YAML allows in a file, or 0. */
static size_t printable_character(const unsigned char *text, size_t length)
{
    unsigned char lead = text[0];
    if (lead < 0x80)
        return (lead >= 0x20 && lead != 0x7F) || lead == '\t' || lead == '\n' || lead == '\r';
    size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || size > length)
        return 0;
    uint32_t code = lead & (0xFFU >> (size + 1));
    for (size_t i = 1; i < size; i++) {
        if ((text[i] & 0xC0) != 0x80)
            return 0;
        code = code << 6 | (text[i] & 0x3FU);
    }
    static const uint32_t least[] = {0, 0, 0xA0, 0x800, 0x10000};
    bool surrogate = code >= 0xD800 && code < 0xE000;
    return code < least[size] || code > 0x10FFFF || surrogate || code == 0xFFFE || code == 0xFFFF ? 0 : size;
}

static bool check_characters(struct diagnostics *report)
{
    const unsigned char *text = (const unsigned char *)report->text;
    struct scene_place place = {1, 1};
    for (size_t at = 0, size; at < report->length; at += size) {
        size = printable_character(text + at, report->length - at);
        if (size == 0) {
            report_error(report, place, "must be printable UTF-8 text, has the byte 0x%02X", text[at]);
            return false;
        }
        place.column++;
        if (text[at] == '\n' || (text[at] == '\r' && (at + 1 == report->length || text[at + 1] != '\n')))
            place = (struct scene_place){place.line + 1, 1};
    }
    return true;
}

static void drop_output(struct fy_diag *diag, void *user, const char *text, size_t length)
{
    (void)diag;
    (void)user;
    (void)text;
    (void)length;
}

/* A diagnostic that keeps libfyaml's errors and prints nothing. */
static struct fy_diag *create_diagnostic(void)
{
    struct fy_diag_cfg config;
    fy_diag_cfg_default(&config);
    config.fp = NULL;
    config.output_fn = drop_output;
    struct fy_diag *diag = fy_diag_create(&config);
    if (diag)
        fy_diag_set_collect_errors(diag, true);
    return diag;
}

static void report_syntax_errors(struct builder *builder, struct fy_diag *diag)
{
    void *previous = NULL;
    bool any = false;
    for (struct fy_diag_error *error; (error = fy_diag_errors_iterate(diag, &previous));) {
        if (error->type != FYET_ERROR)
            continue;
        report_error(builder->report, (struct scene_place){error->line, error->column}, "YAML syntax: %s",
                     error->msg);
        any = true;
    }
    if (!any)
        report_error(builder->report, builder->place, "not YAML 1.2 from here on");
    builder->tree->root = NULL;
}

void yaml_parse(struct diagnostics *report, struct yaml_tree *tree)
{
    *tree = (struct yaml_tree){0};
    if (!check_characters(report))
        return;

    struct builder builder = {.report = report, .tree = tree, .place = {1, 1}};
    struct fy_diag *diag = create_diagnostic();
    struct fy_parser *parser =
        !diag ? NULL
              : fy_parser_create(&(struct fy_parse_cfg){
                    .search_path = "",
                    .flags = FYPCF_DEFAULT_VERSION_1_2 | FYPCF_JSON_NONE | FYPCF_DISABLE_DEPTH_LIMIT,
                    .diag = diag,
                });
    if (!parser || fy_parser_set_string(parser, report->text, report->length) != 0) {
        report->no_memory = true;
    } else {
        struct fy_event *event;
        errno = 0;
        while (!builder.ended && !report->no_memory && (event = fy_parser_parse(parser))) {
            add_event(&builder, event);
            fy_parser_event_free(parser, event);
        }
        report->no_memory = report->no_memory || errno == ENOMEM;
        if (!builder.ended && !report->no_memory)
            report_syntax_errors(&builder, diag);
    }
    fy_parser_destroy(parser);
    fy_diag_destroy(diag);
}
