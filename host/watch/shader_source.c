#include "watch/shader_source.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_file.h"

enum {
    MOST_BYTES = 4 << 20, /* of the expanded shader */
    MOST_FILES = 256,
    MOST_PROBLEMS = 100,
    MOST_NESTED = 64, /* conditionals in a file */
};

/* glslang puts blanks between the words of an #error, so only a name is put there. */
#define PROBLEM "VKWHITTED_PROBLEM_"

struct expansion {
    struct shader_source *source;
    FILE *text;
};

/* A file being expanded. */
struct open_file {
    const char *path;
    const struct open_file *includer;
    size_t number; /* in source->files */
    const char *at, *end;
    int line;
    int comment_line; /* where an open block comment begins; 0: there is none */
    int nested;
    int conditional_lines[MOST_NESTED];
};

static void expand_file(struct expansion *expansion, const char *path, const struct open_file *includer);

/* The file's index in source->files, where it is put unless it is there; MOST_FILES without room. */
static size_t note_file(struct expansion *expansion, const char *path)
{
    struct shader_source *source = expansion->source;
    size_t number = 0;
    while (number < source->file_count && strcmp(source->files[number], path) != 0)
        ++number;
    if (number < source->file_count)
        return number;
    if (number == MOST_FILES || !(source->files[number] = strdup(path)))
        return MOST_FILES;
    ++source->file_count;
    return number;
}

/* An #error at the line of the file. */
__attribute__((format(printf, 4, 5))) static void
put_error(const struct expansion *expansion, const struct open_file *file, int line, const char *format, ...)
{
    struct shader_source *source = expansion->source;
    va_list arguments;
    va_start(arguments, format);
    if (source->problem_count < MOST_PROBLEMS &&
        vasprintf(&source->problems[source->problem_count], format, arguments) >= 0)
        fprintf(expansion->text, "\n#line %d %zu\n#error " PROBLEM "%zu\n", line, file->number,
                source->problem_count++);
    va_end(arguments);
}

/* Whether what is named so exists beside the file; its path is to be freed by the caller. */
static bool find_beside(struct expansion *expansion, const struct open_file *file, const char *name,
                        char **path)
{
    const char *slash = strrchr(file->path, '/');
    int folder_length = slash && name[0] != '/' ? (int)(slash + 1 - file->path) : 0;
    FILE *exists = NULL;
    if (asprintf(path, "%.*s%s", folder_length, file->path, name) < 0)
        *path = NULL;
    else if (note_file(expansion, *path) < MOST_FILES)
        exists = fopen(*path, "re");
    if (exists)
        fclose(exists);
    return exists != NULL;
}

static void include(struct expansion *expansion, const struct open_file *file, const char *name)
{
    for (const struct open_file *includer = file; includer; includer = includer->includer) {
        char *path;
        bool found = find_beside(expansion, includer, name, &path);
        const struct open_file *open = file;
        while (found && open && strcmp(open->path, path) != 0)
            open = open->includer;
        if (found && open)
            put_error(expansion, file, file->line, "the file includes itself: %s", name);
        else if (found)
            expand_file(expansion, path, file);
        free(path);
        if (found)
            return;
    }
    put_error(expansion, file, file->line, "cannot include %s: %s", name, strerror(ENOENT));
}

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\t'))
        ++at;
    return at;
}

/* If a directive stands here, returns what is behind its name. */
static const char *match_directive(const struct open_file *file, char word[16])
{
    const char *at = skip_blanks(file->at, file->end);
    if (at == file->end || *at != '#')
        return NULL;
    at = skip_blanks(at + 1, file->end);
    size_t length = 0;
    while (at < file->end && isalpha((unsigned char)*at) && length < 15)
        word[length++] = *at++;
    word[length] = 0;
    return at;
}

/* Replaces the #include whose name begins at `at`, unless it is malformed: glslang says so then. */
static void expand_include(struct expansion *expansion, struct open_file *file, const char *at)
{
    char name[1024];
    at = skip_blanks(at, file->end);
    if (at == file->end || (*at != '"' && *at != '<'))
        return;
    const char *closing = memchr(at + 1, *at == '"' ? '"' : '>', (size_t)(file->end - at - 1));
    size_t length = closing ? (size_t)(closing - at - 1) : sizeof name;
    if (length == 0 || length >= sizeof name || memchr(at, '\n', length))
        return;
    memcpy(name, at + 1, length);
    name[length] = 0;
    include(expansion, file, name);
    fprintf(expansion->text, "\n#line %d %zu\n", file->line, file->number);
    file->at = closing + 1;
}

/* Keeps count of open conditionals, so that one without end is noticed in its own file. */
static void expand_directive(struct expansion *expansion, struct open_file *file)
{
    char word[16];
    const char *behind = match_directive(file, word);
    if (!behind)
        return;
    if (strcmp(word, "include") == 0) {
        expand_include(expansion, file, behind);
    } else if (strncmp(word, "if", 2) == 0 && file->nested < MOST_NESTED) {
        file->conditional_lines[file->nested++] = file->line;
    } else if (strcmp(word, "endif") == 0) {
        if (file->nested == 0) {
            put_error(expansion, file, file->line, "#endif without #if");
            file->at = behind;
        } else {
            --file->nested;
        }
    }
}

/* Copies to the end of the line, or of the last line that a backslash or a comment joins to it. */
static void copy_line(struct expansion *expansion, struct open_file *file)
{
    bool in_line_comment = false;
    while (file->at < file->end) {
        const char *at = file->at;
        size_t length = 1;
        bool two = at + 1 < file->end;
        if (file->comment_line) {
            if (two && at[0] == '*' && at[1] == '/') {
                file->comment_line = 0;
                length = 2;
            }
        } else if (!in_line_comment && two && at[0] == '/' && at[1] == '*') {
            file->comment_line = file->line;
            length = 2;
        } else if (two && at[0] == '/' && at[1] == '/') {
            in_line_comment = true;
            length = 2;
        } else if (two && at[0] == '\\' && at[1] == '\n') {
            length = 2;
        }
        fwrite(at, 1, length, expansion->text);
        file->at += length;
        if (at[length - 1] == '\n')
            ++file->line;
        if (length == 1 && at[0] == '\n' && !file->comment_line)
            return;
    }
}

static void end_file(struct expansion *expansion, const struct open_file *file)
{
    if (file->comment_line) {
        fputs("*/", expansion->text);
        put_error(expansion, file, file->comment_line, "comment without end");
    }
    for (int i = 0; i < file->nested; ++i)
        fputs("\n#endif", expansion->text);
    if (file->nested > 0)
        put_error(expansion, file, file->conditional_lines[file->nested - 1], "#if without #endif");
}

/* Why the file's text cannot be used; NULL: it can be. */
static const char *judge_text(const struct expansion *expansion, const struct open_file *file,
                              const char *text, size_t length)
{
    if (file->number == MOST_FILES)
        return "too many files";
    if (!text)
        return strerror(errno);
    if (strlen(text) != length)
        return "not a text, it has a byte of value 0";
    return ftello(expansion->text) > MOST_BYTES ? "the shader has become too long" : NULL;
}

static void expand_file(struct expansion *expansion, const char *path, const struct open_file *includer)
{
    struct open_file file = {.path = path, .includer = includer, .line = 1};
    size_t length;
    file.number = note_file(expansion, path);
    char *text = text_file_read(path, true, MOST_BYTES, &length);
    const char *problem = judge_text(expansion, &file, text, length);
    if (problem && includer) {
        put_error(expansion, includer, includer->line, "cannot include %s: %s", path, problem);
    } else if (problem) {
        fputs("#version 460", expansion->text);
        put_error(expansion, &file, 1, "%s", problem);
    } else {
        if (includer)
            fprintf(expansion->text, "#line 1 %zu\n", file.number);
        file.at = text;
        file.end = text + length;
        while (file.at < file.end) {
            expand_directive(expansion, &file);
            copy_line(expansion, &file);
        }
        end_file(expansion, &file);
    }
    free(text);
}

enum status shader_source_read(const char *path, struct shader_source *source)
{
    *source = (struct shader_source){
        .files = calloc(MOST_FILES, sizeof *source->files),
        .problems = calloc(MOST_PROBLEMS, sizeof *source->problems),
    };
    struct expansion expansion = {.source = source, .text = open_memstream(&source->text, &source->length)};
    bool complete = source->files && source->problems && expansion.text;
    if (complete)
        expand_file(&expansion, path, NULL);
    if (expansion.text)
        complete = !ferror(expansion.text) && fclose(expansion.text) == 0 && complete;
    if (complete && source->file_count > 0)
        return STATUS_DONE;
    log_error("no memory for the shader %s", path);
    shader_source_destroy(source);
    return STATUS_UNABLE;
}

void shader_source_destroy(struct shader_source *source)
{
    for (size_t i = 0; i < source->file_count; ++i)
        free(source->files[i]);
    for (size_t i = 0; i < source->problem_count; ++i)
        free(source->problems[i]);
    free(source->files);
    free(source->problems);
    free(source->text);
    *source = (struct shader_source){0};
}

/* Without the noise in which glslang wraps it. */
static void put_text(FILE *messages, const struct shader_source *source, const char *text, int length)
{
    static const char directive[] = "'#error' : ", unnamed[] = "'' :";
    size_t problem;
    if (strncmp(text, unnamed, sizeof unnamed - 1) == 0) {
        text += sizeof unnamed - 1;
        length -= (int)sizeof unnamed - 1;
    }
    for (; length > 0 && *text == ' '; --length)
        ++text;
    while (length > 0 && text[length - 1] == ' ')
        --length;
    if (sscanf(text, "'#error' : " PROBLEM "%zu", &problem) == 1 && problem < source->problem_count)
        fprintf(messages, "%s\n", source->problems[problem]);
    else if (strncmp(text, directive, sizeof directive - 1) == 0)
        fprintf(messages, "#error %.*s\n", length - (int)sizeof directive + 1, text + sizeof directive - 1);
    else
        fprintf(messages, "%.*s\n", length, text);
}

static void put_message(FILE *messages, const struct shader_source *source, const char *line, int length)
{
    static const char *const severities[][2] = {{"ERROR: ", "error"}, {"WARNING: ", "warning"}};
    static const char *const endings[] = {"No code generated", "compilation terminated", "missing #endif"};
    const char *severity = "note";
    for (size_t i = 0; i < 2; ++i)
        if (strncmp(line, severities[i][0], strlen(severities[i][0])) == 0) {
            severity = severities[i][1];
            length -= (int)strlen(severities[i][0]);
            line += strlen(severities[i][0]);
        }
    size_t file;
    int number, used = 0;
    bool noise = false; /* a missing #endif is known already, and better where */
    for (size_t i = 0; i < 3 && length > 0; ++i)
        noise |= memmem(line, (size_t)length, endings[i], strlen(endings[i])) != NULL;
    if (length <= 0 || noise)
        return;
    if (sscanf(line, "%zu:%d: %n", &file, &number, &used) == 2 && used > 0 && file < source->file_count) {
        fprintf(messages, "%s:%d: %s: ", source->files[file], number, severity);
        put_text(messages, source, line + used, length - used);
    } else {
        fprintf(messages, "%s: %s: ", source->files[0], severity);
        put_text(messages, source, line, length);
    }
}

char *shader_source_messages(const struct shader_source *source, const char *log)
{
    char *text = NULL;
    size_t size;
    FILE *messages = open_memstream(&text, &size);
    if (!messages)
        return NULL;
    while (*log) {
        int length = (int)strcspn(log, "\n");
        put_message(messages, source, log, length);
        log += length + (log[length] == '\n');
    }
    bool complete = !ferror(messages);
    if (fclose(messages) == 0 && complete)
        return text;
    free(text);
    return NULL;
}
