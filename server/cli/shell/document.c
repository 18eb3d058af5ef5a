// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/document.h"

#include "base/visible.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char MORE[] = ", \xe2\x80\xa6";

cJSON *hn_document_parse(hn_strbuf *text) {
    cJSON *document = text->failed ? NULL : cJSON_Parse(hn_strbuf_text(text));
    hn_strbuf_reset(text);
    return document;
}

const cJSON *hn_document_get(const cJSON *object, const char *key) {
    return cJSON_GetObjectItemCaseSensitive(object, key);
}

double hn_document_number(const cJSON *object, const char *key) {
    const cJSON *item = hn_document_get(object, key);
    return cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
}

const char *hn_document_text(const cJSON *object, const char *key) {
    const char *text = cJSON_GetStringValue(hn_document_get(object, key));
    return text ? text : "";
}

void hn_document_put_number(hn_strbuf *b, const cJSON *number) {
    if (cJSON_IsNumber(number)) {
        hn_strbuf plain; // a buffer of its own: no commas
        hn_strbuf_init(&plain);
        hn_json_number(&plain, number->valuedouble);
        hn_strbuf_add(b, hn_strbuf_text(&plain));
        b->failed |= plain.failed;
        hn_strbuf_reset(&plain);
    }
}

/// A scalar as a person would write it.
static void format_scalar(const cJSON *item, char out[HN_TABLE_CELL]) {
    if (cJSON_IsString(item)) {
        snprintf(out, HN_TABLE_CELL, "%s", item->valuestring);
    } else if (cJSON_IsNumber(item)) {
        snprintf(out, HN_TABLE_CELL, "%.6g", item->valuedouble);
    } else {
        snprintf(out, HN_TABLE_CELL, "%s",
                 cJSON_IsTrue(item)    ? "yes"
                 : cJSON_IsFalse(item) ? "no"
                                       : "-");
    }
}

/// The same, whole however long it is.
static void put_scalar(hn_strbuf *b, const cJSON *item) {
    char text[HN_TABLE_CELL];
    if (cJSON_IsString(item)) {
        hn_visible_add(b, item->valuestring, true);
        return;
    }
    format_scalar(item, text);
    hn_strbuf_add(b, text);
}

/// A scalar, or the scalars of an array with commas between; what has no room is marked by an
/// ellipsis.
static void format_cell(const cJSON *item, char out[HN_TABLE_CELL]) {
    if (!cJSON_IsArray(item)) {
        format_scalar(item, out);
        return;
    }
    size_t used = 0;
    const cJSON *part;
    out[0] = 0;
    cJSON_ArrayForEach(part, item) {
        char text[HN_TABLE_CELL];
        format_scalar(part, text);
        if (used + strlen(text) + sizeof MORE + 3 > HN_TABLE_CELL) {
            snprintf(out + used, HN_TABLE_CELL - used, "%s", MORE);
            return;
        }
        used += (size_t)snprintf(out + used, HN_TABLE_CELL - used, "%s%s", used ? ", " : "", text);
    }
}

void hn_document_list(hn_strbuf *b, const cJSON *array, const hn_list_column *columns, int n) {
    hn_table t;
    hn_table_init(&t);
    for (int c = 0; c < n; c++) {
        hn_table_column(&t, columns[c].head, columns[c].unit != NULL);
    }

    // a quantity with its unit, or text
    const cJSON *row;
    cJSON_ArrayForEach(row, array) {
        for (int c = 0; c < n; c++) {
            char text[HN_TABLE_CELL];
            const cJSON *item = hn_document_get(row, columns[c].key);
            if (columns[c].unit && columns[c].unit[0] && cJSON_IsNumber(item)) {
                hn_table_quantity(&t, item->valuedouble, columns[c].unit);
                continue;
            }
            format_cell(item, text);
            hn_table_cell(&t, "%s", item ? text : "");
        }
    }
    hn_table_write(b, &t);
    hn_table_reset(&t);
}

static bool is_scalar(const cJSON *item) {
    return !cJSON_IsArray(item) && !cJSON_IsObject(item);
}

static int holds_objects(const cJSON *array) {
    return cJSON_IsObject(array->child);
}

static int find_column(const hn_list_column *columns, int n, const char *key) {
    for (int c = 0; c < n; c++) {
        if (strcmp(columns[c].key, key) == 0) {
            return c;
        }
    }
    return -1;
}

// ---- outlines ----

enum { MAX_PATH = 100, STEP = 2 };

/// Describes where an outline has come to.
typedef struct outline {
    hn_strbuf *b;
    const hn_outline_word *words;
    char path[MAX_PATH]; ///< of the object, with a point behind it; "" at the top
    int indent;
} outline;

/// Returns how a member of the object at hand is named for people.
static const char *words_of(const outline *o, const char *key) {
    char path[2 * MAX_PATH];
    snprintf(path, sizeof path, "%s%.90s", o->path, key);
    for (const hn_outline_word *w = o->words; w->path; w++) {
        if (strcmp(w->path, path) == 0) {
            return w->words;
        }
    }
    return key;
}

/// The outline of a member that has members.
static outline step_into(const outline *o, const char *key) {
    outline inner = *o;
    snprintf(inner.path + strlen(o->path), sizeof inner.path - strlen(o->path), "%.40s.", key);
    inner.indent += STEP;
    return inner;
}

/// Adds the lines of a text, each as far to the right as the outline is.
static void put_indented(const outline *o, const char *text) {
    while (*text) {
        const size_t n = strcspn(text, "\n");
        hn_strbuf_printf(o->b, "%*s%.*s\n", o->indent, "", (int)n, text);
        text += n + (text[n] == '\n');
    }
}

/// A table of objects, its columns the members that any of them has; members with parts of their
/// own are left out.
static void put_objects(const outline *o, const cJSON *array) {
    hn_list_column columns[HN_TABLE_COLUMNS];
    int n = 0;
    for (const cJSON *row = array->child; row; row = row->next) {
        for (const cJSON *m = row->child; m && n < HN_TABLE_COLUMNS; m = m->next) {
            const int flat =
                is_scalar(m) || (cJSON_IsArray(m) && (!m->child || is_scalar(m->child)));
            if (flat && find_column(columns, n, m->string) < 0) {
                columns[n++] = (hn_list_column){words_of(o, m->string), m->string,
                                                cJSON_IsNumber(m) ? "" : NULL};
            }
        }
    }

    // made beside, then moved to its place
    hn_strbuf table;
    hn_strbuf_init(&table);
    hn_document_list(&table, array, columns, n);
    put_indented(o, hn_strbuf_text(&table));
    o->b->failed |= table.failed;
    hn_strbuf_reset(&table);
}

/// Text that is laid out by its own indentation stands line by line.
static bool holds_lines(const cJSON *array) {
    const cJSON *item;
    cJSON_ArrayForEach(item, array) {
        if (cJSON_IsString(item) && item->valuestring[0] == ' ') {
            return true;
        }
    }
    return false;
}

static void put_lines(const outline *o, const cJSON *array) {
    const cJSON *item;
    cJSON_ArrayForEach(item, array) {
        put_indented(o, item->valuestring);
    }
}

static void put_line(hn_strbuf *b, const cJSON *array) {
    const cJSON *item;
    hn_strbuf_add(b, array->child ? "" : "none");
    cJSON_ArrayForEach(item, array) {
        if (cJSON_IsArray(item)) {
            hn_strbuf_add(b, "[");
            put_line(b, item);
            hn_strbuf_add(b, "]");
        } else {
            put_scalar(b, item);
        }
        hn_strbuf_add(b, item->next ? ", " : "");
    }
}

static bool is_one_line(const cJSON *item) {
    return is_scalar(item) ||
           (cJSON_IsArray(item) && !(item->child && holds_objects(item)) && !holds_lines(item));
}

static void put_members(const outline *o, const cJSON *object) {
    int width = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, object) {
        const int n = (int)strlen(words_of(o, item->string));
        width = n > width && is_one_line(item) ? n : width;
    }

    // lines, then what is nested, indented
    cJSON_ArrayForEach(item, object) {
        const char *words = words_of(o, item->string);
        hn_strbuf_printf(o->b, "%*s%-*s", o->indent, "", is_one_line(item) ? width + 2 : 0, words);
        if (is_scalar(item)) {
            put_scalar(o->b, item);
        } else if (is_one_line(item)) {
            put_line(o->b, item);
        }
        hn_strbuf_add(o->b, "\n");
        const outline inner = step_into(o, item->string);
        if (cJSON_IsObject(item)) {
            put_members(&inner, item);
        } else if (!is_one_line(item)) {
            (holds_lines(item) ? put_lines : put_objects)(&inner, item);
        }
    }
}

void hn_document_outline(hn_strbuf *b, const cJSON *object, const hn_outline_word *words) {
    const outline o = {.b = b, .words = words};
    put_members(&o, object);
}

void hn_document_matrix(hn_strbuf *b, const char *name, const cJSON *rows, const cJSON *row_names,
                        const cJSON *column_names) {
    if (!cJSON_IsArray(rows)) {
        return;
    }
    hn_strbuf_printf(b, "%s\n", name);
    int width = 0;
    const cJSON *item, *cell;
    cJSON_ArrayForEach(item, row_names) {
        int n = (int)strlen(item->valuestring);
        width = n > width ? n : width;
    }

    // heads of columns
    if (column_names) {
        hn_strbuf_printf(b, "  %*s", width, "");
        cJSON_ArrayForEach(item, column_names) {
            hn_strbuf_printf(b, " %13s", item->valuestring);
        }
        hn_strbuf_add(b, "\n");
    }

    // rows; a vector has one number in each
    int i = 0;
    cJSON_ArrayForEach(item, rows) {
        const cJSON *row_name = cJSON_GetArrayItem(row_names, i++);
        hn_strbuf_printf(b, "  %-*s", width, row_name ? row_name->valuestring : "");
        if (cJSON_IsNumber(item)) {
            hn_strbuf_printf(b, " %13.6g", item->valuedouble);
        }
        cJSON_ArrayForEach(cell, item) {
            hn_strbuf_printf(b, " %13.6g", cell->valuedouble);
        }
        hn_strbuf_add(b, "\n");
    }
}
