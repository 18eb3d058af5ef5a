// SPDX-License-Identifier: GPL-3.0-or-later
#include "lesson/lesson.h"

#include "base/file.h"
#include "base/suggest.h"
#include "lesson/markdown.h"
#include "session/model/lists.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_TEXT = 1 << 20, MAX_LESSONS = 100, MAX_LINE = 2000 };

// ---- special blocks ----

/// The next line of a text without its end; 0 when there is none.
static int next_line(const char **at, char line[MAX_LINE]) {
    if (!**at) {
        return 0;
    }
    const size_t n = strcspn(*at, "\n");
    snprintf(line, MAX_LINE, "%.*s", (int)n, *at);
    *at += n + ((*at)[n] == '\n');
    return 1;
}

static const char *skip_blanks(const char *text) {
    return text + strspn(text, " \t");
}

/// Parses Markdown into the member `key` of a node.
static hn_status put_children(cJSON *node, const char *key, const char *text) {
    cJSON *children = cJSON_AddArrayToObject(node, key);
    return children ? hn_markdown_parse(text, strlen(text), children) : HN_ERR_MEMORY;
}

/// Words separated by blanks as an array.
static void put_words(cJSON *node, const char *key, const char *text) {
    cJSON *array = cJSON_AddArrayToObject(node, key);
    for (const char *p = skip_blanks(text); *p; p = skip_blanks(p)) {
        char word[MAX_LINE];
        const size_t n = strcspn(p, " \t");
        snprintf(word, sizeof word, "%.*s", (int)n, p);
        cJSON_AddItemToArray(array, cJSON_CreateString(word));
        p += n;
    }
}

/// The command that shows what scene, methods, set and time describe.
static void derive_command(cJSON *node) {
    const char *scene = cJSON_GetStringValue(cJSON_GetObjectItem(node, "scene"));
    const cJSON *methods = cJSON_GetObjectItem(node, "methods"), *word;
    hn_strbuf b;
    hn_strbuf_init(&b);

    // one method runs; several, or none named, are compared
    const int several = cJSON_GetArraySize(methods) != 1;
    hn_strbuf_printf(&b, "%s %s", several ? "compare" : "run", scene ? scene : "");

    // the options, in the order in which a person writes them
    cJSON_ArrayForEach(word, cJSON_GetObjectItem(node, "set")) {
        hn_strbuf_printf(&b, " --set %s", word->valuestring);
    }
    if (methods) {
        hn_strbuf_add(&b, several ? " --methods" : " --method");
    }
    cJSON_ArrayForEach(word, methods) {
        hn_strbuf_printf(&b, " %s", word->valuestring);
    }
    const cJSON *time = cJSON_GetObjectItem(node, "time");
    if (time) {
        hn_strbuf_printf(&b, " --time %g", time->valuedouble);
    }

    // a single run shows its plot
    hn_strbuf_add(&b, several ? "" : " --plot");
    cJSON_AddStringToObject(node, "command", hn_strbuf_text(&b));
    hn_strbuf_reset(&b);
}

enum { N_EXHIBIT_KEYS = 6 };

/// Refuses a line of an exhibit, with the nearest key or all of them.
static hn_status refuse_line(const char *line, const char *const keys[N_EXHIBIT_KEYS],
                             hn_diags *diags) {
    const char *near = hn_nearest_name(line, keys, N_EXHIBIT_KEYS);
    char hint[HN_DIAG_HINT];
    int n = snprintf(hint, sizeof hint, "write 'key: text' with a key of ");
    for (int i = 0; i < N_EXHIBIT_KEYS; i++) {
        n += snprintf(hint + n, sizeof hint - (size_t)n, "%s%s", i ? ", " : "", keys[i]);
    }
    if (near) {
        snprintf(hint, sizeof hint, "did you mean '%s:'?", near);
    }
    return hn_diags_add(diags, HN_ERR_INPUT, "/exhibit", hint,
                        "the line '%.60s' of an exhibit cannot be read", line);
}

/// Lines "key: value"; an empty line, then what to see.
static hn_status read_exhibit(cJSON *node, const char *text, hn_diags *diags) {
    static const char *const keys[N_EXHIBIT_KEYS] = {"command", "scene", "methods",
                                                     "set",     "time",  "look"};
    char line[MAX_LINE];
    while (next_line(&text, line) && *skip_blanks(line)) {
        // key and value
        char *colon = strchr(line, ':');
        const char *value = colon ? skip_blanks(colon + 1) : "";
        if (colon) {
            *colon = 0;
        }

        int k = 0;
        while (k < N_EXHIBIT_KEYS && strcmp(keys[k], line) != 0) {
            k++;
        }
        if (!colon || k == N_EXHIBIT_KEYS) {
            return refuse_line(line, keys, diags);
        }

        // lists, the time in seconds, and texts
        if (k == 2 || k == 3) {
            put_words(node, keys[k], value);
        } else if (k == 4) {
            cJSON_AddNumberToObject(node, keys[k], strtod(value, NULL));
        } else {
            cJSON_AddStringToObject(node, keys[k], value);
        }
    }

    // a command that is written out goes before a derived one
    if (!cJSON_GetObjectItem(node, "command")) {
        derive_command(node);
    }
    return put_children(node, "children", text);
}

static hn_status add_choice(cJSON *choices, const char *text) {
    cJSON *choice = cJSON_CreateObject();
    return choice && cJSON_AddItemToArray(choices, choice) ? put_children(choice, "children", text)
                                                           : HN_ERR_MEMORY;
}

/// The question; lines "- choice" and "+ right choice"; an empty line, then what was seen.
static hn_status read_predict(cJSON *node, const char *text, hn_diags *diags) {
    char line[MAX_LINE];
    hn_strbuf question;
    hn_strbuf_init(&question);
    cJSON *choices = cJSON_AddArrayToObject(node, "choices");
    int n = 0, right = -1;
    hn_status status = HN_OK;
    while (status == HN_OK && next_line(&text, line) && (*skip_blanks(line) || n == 0)) {
        if ((line[0] == '-' || line[0] == '+') && line[1] == ' ') {
            right = line[0] == '+' ? n : right;
            status = add_choice(choices, line + 2);
            n++;
        } else {
            hn_strbuf_printf(&question, "%s\n", line);
        }
    }

    // a question without its right choice is a fault of the text
    if (status == HN_OK && (right < 0 || n < 2)) {
        status = hn_diags_add(diags, HN_ERR_INPUT, "/predict", NULL,
                              "a prediction needs two choices or more and one of them with '+': "
                              "%.120s",
                              hn_strbuf_text(&question));
    }
    cJSON_AddNumberToObject(node, "right", right);
    status = status == HN_OK ? put_children(node, "children", hn_strbuf_text(&question)) : status;
    hn_strbuf_reset(&question);
    return status == HN_OK ? put_children(node, "after", text) : status;
}

static hn_status read_slip(cJSON *node, const char *text, const char *word) {
    cJSON_AddNumberToObject(node, "number", strtod(word, NULL));
    return put_children(node, "children", text);
}

static hn_status read_exercise(cJSON *node, const char *text, const char *word) {
    cJSON_AddStringToObject(node, "id", word);
    return put_children(node, "children", text);
}

/// Turns a code block into the special kind that its first word names.
static hn_status specialise(cJSON *node, hn_diags *diags) {
    static const char *const kinds[] = {"exhibit", "predict", "slip", "exercise"};
    const char *info = cJSON_GetStringValue(cJSON_GetObjectItem(node, "info"));
    char kind[MAX_LINE], word[MAX_LINE];
    const size_t n = info ? strcspn(info, " ") : 0;
    snprintf(kind, sizeof kind, "%.*s", (int)n, info ? info : "");
    snprintf(word, sizeof word, "%s", info ? skip_blanks(info + n) : "");
    int k = 0;
    while (k < 4 && strcmp(kind, kinds[k]) != 0) {
        k++;
    }
    if (k == 4) {
        return HN_OK;
    }

    // the text moves from the code block into members of its own
    cJSON *text = cJSON_DetachItemFromObject(node, "text");
    cJSON_DeleteItemFromObject(node, "info");
    cJSON_SetValuestring(cJSON_GetObjectItem(node, "kind"), kind);
    const char *content = text ? text->valuestring : "";
    const hn_status status = k == 0   ? read_exhibit(node, content, diags)
                             : k == 1 ? read_predict(node, content, diags)
                             : k == 2 ? read_slip(node, content, word)
                                      : read_exercise(node, content, word);
    cJSON_Delete(text);
    return status;
}

hn_status hn_lesson_parse(const char *text, size_t n, cJSON **blocks, hn_diags *diags) {
    cJSON *array = cJSON_CreateArray(), *node;
    hn_status status = array ? hn_markdown_parse(text, n, array) : HN_ERR_MEMORY;
    cJSON_ArrayForEach(node, array) {
        const char *kind = cJSON_GetStringValue(cJSON_GetObjectItem(node, "kind"));
        if (status == HN_OK && kind && strcmp(kind, "code") == 0) {
            status = specialise(node, diags);
        }
    }
    if (status != HN_OK) {
        cJSON_Delete(array);
        array = NULL;
    }
    *blocks = array;
    return status;
}

// ---- files ----

/// The id of the lesson that a word names: its number, or the id itself. NULL, with a fault, if
/// there is none.
static const char *find_id(const cJSON *list, const char *word, hn_diags *diags) {
    // the number, or the id; the ids are kept for the hint
    const char *ids[MAX_LESSONS];
    int n = 0;
    char *end;
    const long number = strtol(word, &end, 10);
    const cJSON *lesson;
    cJSON_ArrayForEach(lesson, list) {
        const char *id = cJSON_GetStringValue(cJSON_GetObjectItem(lesson, "id"));
        if (id && (strcmp(id, word) == 0 || (!*end && *word && strtol(id, NULL, 10) == number))) {
            return id;
        }
        if (id && n < MAX_LESSONS) {
            ids[n++] = id;
        }
    }

    // what to try instead
    char hint[HN_DIAG_HINT];
    hn_suggest(hint, word, ids, n, "'holonom lessons' lists them all");
    hn_diags_add(diags, HN_ERR_INPUT, "/lesson", hint, "there is no lesson '%.60s'", word);
    return NULL;
}

/// Fills in the blocks of lessons/ID/text.md.
static hn_status read_text(const hn_library *lib, const char *id, cJSON *lesson, hn_diags *diags) {
    hn_strbuf path, text;
    hn_strbuf_init(&path);
    hn_strbuf_init(&text);
    hn_strbuf_printf(&path, "%s/%s/text.md", hn_library_lessons(lib), id);
    cJSON *blocks = NULL;
    hn_status status =
        path.failed ? HN_ERR_MEMORY : hn_file_load(hn_strbuf_text(&path), MAX_TEXT, &text, diags);
    HN_THEN(status, hn_lesson_parse(hn_strbuf_text(&text), text.n, &blocks, diags));
    if (status == HN_OK && !cJSON_AddItemToObject(lesson, "blocks", blocks)) {
        cJSON_Delete(blocks);
        status = HN_ERR_MEMORY;
    }
    hn_strbuf_reset(&path);
    hn_strbuf_reset(&text);
    return status;
}

hn_status hn_lesson_load(const hn_library *lib, const char *word, cJSON **out, hn_diags *diags) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_lessons_json(&b, lib);
    cJSON *list = cJSON_Parse(hn_strbuf_text(&b)), *lesson = cJSON_CreateObject(), *entry;
    hn_strbuf_reset(&b);
    *out = NULL;
    hn_status status = list && lesson ? HN_OK : HN_ERR_MEMORY;
    const char *id =
        status == HN_OK ? find_id(cJSON_GetObjectItem(list, "lessons"), word, diags) : NULL;
    status = status == HN_OK && !id ? HN_ERR_INPUT : status;

    // what the list knows of it, then its text
    cJSON_ArrayForEach(entry, cJSON_GetObjectItem(list, "lessons")) {
        const char *own = cJSON_GetStringValue(cJSON_GetObjectItem(entry, "id"));
        for (const cJSON *m = id && own && strcmp(own, id) == 0 ? entry->child : NULL; m;
             m = m->next) {
            cJSON_AddItemToObject(lesson, m->string, cJSON_Duplicate(m, 1));
        }
    }
    if (status == HN_OK) {
        cJSON_AddNumberToObject(lesson, "number", strtod(id, NULL));
        status = read_text(lib, id, lesson, diags);
    }
    cJSON_Delete(list);
    if (status != HN_OK) {
        cJSON_Delete(lesson);
        return status;
    }
    *out = lesson;
    return HN_OK;
}

void hn_lesson_json(hn_strbuf *b, const cJSON *lesson) {
    char *text = cJSON_PrintUnformatted(lesson);
    b->failed |= text == NULL;
    hn_json_raw(b, text ? text : "null");
    free(text);
}
