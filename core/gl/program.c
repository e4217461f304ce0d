/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"
#include "../memory.h"
#include "shader_source.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_INCLUDES 24

/* Text of one shader being put together. */
struct source {
    char *text;
    size_t length, capacity;
    const char *included[MAX_INCLUDES];
    int included_count;
    const char *technique;
};

static bool source_append(struct source *source, const char *text, size_t length) {
    if (source->length + length + 1 > source->capacity) {
        const size_t capacity = 2 * (source->length + length) + 4096;
        char *grown = memory_resize(source->text, capacity, 1);
        if (!grown)
            return false;
        source->text = grown;
        source->capacity = capacity;
    }
    memcpy(source->text + source->length, text, length);
    source->length += length;
    source->text[source->length] = '\0';
    return true;
}

#ifdef PNB_SHADERS_FROM_FOLDER
/* Debug builds: a shader edited in PENUMBRA_SHADER_DIR is used without a rebuild. The text is kept for ever. */
static const char *source_from_folder(const char *name) {
    const char *folder = getenv("PENUMBRA_SHADER_DIR");
    char path[1024];
    if (!folder || snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        return NULL;
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    char *text = calloc(1, 1 << 20);
    if (text && fread(text, 1, (1 << 20) - 1, file) == 0)
        text[0] = '\0';
    fclose(file);
    return text;
}
#endif

static const char *source_find(const char *name) {
#ifdef PNB_SHADERS_FROM_FOLDER
    const char *text = source_from_folder(name);
    if (text)
        return text;
#endif
    for (const struct shader_source *source = shader_sources; source->name; source++)
        if (strcmp(source->name, name) == 0)
            return source->text;
    return NULL;
}

static pnb_result source_add_file(struct source *source, const char *name);

/* Handles one line; an #include adds the file it names. */
static pnb_result source_add_line(struct source *source, const char *line, size_t length) {
    static const char directive[] = "#include \"";
    if (strncmp(line, directive, sizeof directive - 1) != 0) {
        if (!source_append(source, line, length))
            return PNB_ERROR_OUT_OF_MEMORY;
        return PNB_OK;
    }
    char name[64];
    const char *start = line + sizeof directive - 1;
    const char *end = memchr(start, '"', length - (sizeof directive - 1));
    if (!end || (size_t)(end - start) >= sizeof name)
        return error_set(PNB_ERROR_INTERNAL, "shader: malformed include");
    memcpy(name, start, (size_t)(end - start));
    name[end - start] = '\0';
    if (strcmp(name, "technique") == 0)
        return source_add_file(source, source->technique);
    return source_add_file(source, name);
}

static pnb_result source_add_file(struct source *source, const char *name) {
    for (int i = 0; i < source->included_count; i++)
        if (strcmp(source->included[i], name) == 0)
            return PNB_OK;
    const char *text = source_find(name);
    if (!text)
        return error_set(PNB_ERROR_INTERNAL, "shader file '%s' does not exist", name);
    if (source->included_count == MAX_INCLUDES)
        return error_set(PNB_ERROR_INTERNAL, "shader '%s' includes too many files", name);
    /* The table's own string, which outlives the source. */
    for (const struct shader_source *entry = shader_sources; entry->name; entry++)
        if (strcmp(entry->name, name) == 0)
            source->included[source->included_count++] = entry->name;
    while (*text) {
        const char *end = strchr(text, '\n');
        const size_t length = end ? (size_t)(end - text) + 1 : strlen(text);
        pnb_result result = source_add_line(source, text, length);
        if (result != PNB_OK)
            return result;
        text += length;
    }
    return PNB_OK;
}

static pnb_result shader_compile(const struct gl *gl, GLenum stage, const char *file, const struct program_desc *desc,
                                 GLuint *shader) {
    struct source source = {.technique = desc->technique};
    static const char version[] = "#version 430 core\n";
    pnb_result result = PNB_OK;
    if (!source_append(&source, version, sizeof version - 1))
        result = PNB_ERROR_OUT_OF_MEMORY;
    for (int i = 0; i < MAX_DEFINES; i++)
        if (desc->defines[i] && !source_append(&source, desc->defines[i], strlen(desc->defines[i])))
            result = PNB_ERROR_OUT_OF_MEMORY;
    if (result == PNB_OK)
        result = source_add_file(&source, file);
    if (result != PNB_OK) {
        memory_free(source.text);
        return result;
    }
    *shader = gl->CreateShader(stage);
    gl->ShaderSource(*shader, 1, (const GLchar *const *)&source.text, NULL);
    gl->CompileShader(*shader);
    memory_free(source.text);
    GLint compiled = 0;
    gl->GetShaderiv(*shader, GL_COMPILE_STATUS, &compiled);
    if (compiled)
        return PNB_OK;
    char log[700] = "no log";
    gl->GetShaderInfoLog(*shader, sizeof log, NULL, log);
    gl->DeleteShader(*shader);
    return error_set(PNB_ERROR_INTERNAL, "shader '%s' (%s) does not compile: %s", file,
                     desc->technique ? desc->technique : "no technique", log);
}

static pnb_result program_create(const struct gl *gl, const struct program_desc *desc, GLuint *program) {
    const GLenum stages[3] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER, GL_COMPUTE_SHADER};
    const char *files[3] = {desc->vertex, desc->fragment, desc->compute};
    const GLuint id = gl->CreateProgram();
    for (int i = 0; i < 3; i++) {
        if (!files[i])
            continue;
        GLuint shader = 0;
        pnb_result result = shader_compile(gl, stages[i], files[i], desc, &shader);
        if (result != PNB_OK) {
            gl->DeleteProgram(id);
            return result;
        }
        gl->AttachShader(id, shader);
        gl->DeleteShader(shader);
    }
    gl->LinkProgram(id);
    GLint linked = 0;
    gl->GetProgramiv(id, GL_LINK_STATUS, &linked);
    if (!linked) {
        char log[700] = "no log";
        gl->GetProgramInfoLog(id, sizeof log, NULL, log);
        gl->DeleteProgram(id);
        return error_set(PNB_ERROR_INTERNAL, "shader program '%s' does not link: %s",
                         desc->fragment ? desc->fragment : desc->compute, log);
    }
    *program = id;
    return PNB_OK;
}

struct program_entry {
    struct program_desc desc;
    GLuint program;
};

void program_cache_init(struct program_cache *cache, const struct gl *gl) {
    *cache = (struct program_cache){.gl = gl};
}

void program_cache_free(struct program_cache *cache) {
    for (uint32_t i = 0; i < cache->count; i++)
        cache->gl->DeleteProgram(cache->entries[i].program);
    memory_free(cache->entries);
    *cache = (struct program_cache){0};
}

static bool strings_equal(const char *a, const char *b) {
    return a == b || (a && b && strcmp(a, b) == 0);
}

static bool descs_equal(const struct program_desc *a, const struct program_desc *b) {
    for (int i = 0; i < MAX_DEFINES; i++)
        if (!strings_equal(a->defines[i], b->defines[i]))
            return false;
    return strings_equal(a->vertex, b->vertex) && strings_equal(a->fragment, b->fragment) &&
           strings_equal(a->compute, b->compute) && strings_equal(a->technique, b->technique);
}

static pnb_result program_add(struct program_cache *cache, const struct program_desc *desc) {
    if (cache->count == cache->capacity) {
        const uint32_t capacity = 2 * cache->capacity + 16;
        struct program_entry *entries = memory_resize(cache->entries, capacity, sizeof *entries);
        if (!entries)
            return PNB_ERROR_OUT_OF_MEMORY;
        cache->entries = entries;
        cache->capacity = capacity;
    }
    struct program_entry *entry = &cache->entries[cache->count];
    entry->desc = *desc;
    pnb_result result = program_create(cache->gl, desc, &entry->program);
    if (result == PNB_OK)
        cache->count++;
    return result;
}

pnb_result program_use(struct program_cache *cache, const struct program_desc *desc, GLuint *program) {
    uint32_t i = 0;
    while (i < cache->count && !descs_equal(&cache->entries[i].desc, desc))
        i++;
    if (i == cache->count) {
        pnb_result result = program_add(cache, desc);
        if (result != PNB_OK)
            return result;
    }
    *program = cache->entries[i].program;
    cache->gl->UseProgram(*program);
    return PNB_OK;
}

void program_set_int(const struct gl *gl, GLuint program, const char *name, int value) {
    gl->Uniform1i(gl->GetUniformLocation(program, name), value);
}

void program_set_float(const struct gl *gl, GLuint program, const char *name, float value) {
    gl->Uniform1f(gl->GetUniformLocation(program, name), value);
}

void program_set_vec2(const struct gl *gl, GLuint program, const char *name, const float value[2]) {
    gl->Uniform2fv(gl->GetUniformLocation(program, name), 1, value);
}

void program_set_vec3(const struct gl *gl, GLuint program, const char *name, const float value[3]) {
    gl->Uniform3fv(gl->GetUniformLocation(program, name), 1, value);
}

void program_set_vec4(const struct gl *gl, GLuint program, const char *name, const float value[4]) {
    gl->Uniform4fv(gl->GetUniformLocation(program, name), 1, value);
}

void program_set_mat4(const struct gl *gl, GLuint program, const char *name, const float value[16]) {
    gl->UniformMatrix4fv(gl->GetUniformLocation(program, name), 1, GL_FALSE, value);
}
