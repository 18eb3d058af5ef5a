// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/world.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static hn_status refuse(const char *name, const char *what, hn_diag *diag) {
    return hn_diag_set(diag, HN_ERR_INPUT, "/parts/matrices", NULL, "the matrix '%.30s' %s", name,
                       what);
}

static const hn_matrix *look_up(void *user, const char *name) {
    const hn_world *w = user;
    for (int i = 0; i < w->n; i++) {
        if (strcmp(w->name[i], name) == 0) {
            return &w->matrix[i];
        }
    }

    // the identity, where the exercise has no matrix of this name: as a number it fits every shape
    static const char *const identity[] = {"I", "E", "Id", "eye", "identity", NULL};
    static double one[] = {1};
    static const hn_matrix unit = {.rows = 1, .cols = 1, .number = 1, .x = one};
    for (int i = 0; identity[i]; i++) {
        if (strcmp(identity[i], name) == 0) {
            return &unit;
        }
    }
    return NULL;
}

hn_status hn_world_eval(hn_world *w, const char *text, hn_matrix *out, hn_diag *diag) {
    const hn_matrix_names names = {.lookup = look_up, .user = w, .known = w->name, .n_known = w->n};
    return hn_matrix_eval(text, &names, w->arena, out, diag);
}

hn_status hn_world_read(hn_world *w, const char *text, hn_strbuf *read, hn_diag *diag) {
    const hn_matrix_names names = {.lookup = look_up, .user = w, .known = w->name, .n_known = w->n};
    hn_matrix m;
    return hn_matrix_read(text, &names, w->arena, &m, read, diag);
}

/// A size: a number, or a name of "sizes". 0 when it is neither, or too large.
static int size_of(const hn_part *p, const cJSON *node) {
    const cJSON *sizes = cJSON_GetObjectItemCaseSensitive(p->node, "sizes");
    const cJSON *m =
        cJSON_IsString(node) ? cJSON_GetObjectItemCaseSensitive(sizes, node->valuestring) : node;
    const int n = cJSON_IsNumber(m) ? m->valueint : 0;
    return n > 0 && n <= HN_MATRIX_LARGEST ? n : 0;
}

static void fill(hn_matrix *m, uint64_t seed) {
    for (int i = 0; i < m->rows * m->cols; i++) {
        m->x[i] = 2 * hn_draw_random(seed, (uint64_t)i) - 1;
    }
}

/// A A' + I/2
static hn_status make_spd(hn_world *w, int n, uint64_t seed, hn_matrix *out) {
    hn_matrix a = hn_matrix_new(w->arena, n, n);
    *out = hn_matrix_new(w->arena, n, n);
    if (!a.x || !out->x) {
        return HN_ERR_MEMORY;
    }
    fill(&a, seed);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            for (int k = 0; k < n; k++) {
                out->x[i * n + j] += a.x[i * n + k] * a.x[j * n + k];
            }
            out->x[i * n + j] += i == j ? 0.5 : 0;
        }
    }
    return HN_OK;
}

/// N = (I - J' (J J')^-1 J) R with a random R: spans the null space of J.
static hn_status make_null(hn_world *w, const char *of, uint64_t seed, hn_matrix *out,
                           hn_diag *diag) {
    const hn_matrix *J = look_up(w, of);
    if (!J || J->rows >= J->cols || w->n == HN_WORLD_NAMES) {
        return refuse(of, "has no null space here", diag);
    }
    char text[200];
    hn_matrix R = hn_matrix_new(w->arena, J->cols, J->cols - J->rows);
    if (!R.x) {
        return HN_ERR_MEMORY;
    }
    fill(&R, seed);
    w->name[w->n] = "randomR";
    w->matrix[w->n++] = R;
    snprintf(text, sizeof text, "randomR - %.20s'*inv(%.20s*%.20s')*%.20s*randomR", of, of, of, of);
    const hn_status status = hn_world_eval(w, text, out, diag);
    w->n--;
    return status;
}

static hn_status make_one(hn_world *w, const hn_part *p, const cJSON *node, uint64_t seed,
                          hn_matrix *out, hn_diag *diag) {
    // what is asked for, and two sizes or a word
    const char *how = cJSON_GetStringValue(cJSON_GetArrayItem(node, 0));
    const cJSON *first = cJSON_GetArrayItem(node, 1), *second = cJSON_GetArrayItem(node, 2);
    const char *word = cJSON_GetStringValue(first);
    const int rows = size_of(p, first), cols = size_of(p, second);

    // a random matrix, of the sizes that the exercise names
    if (how && strcmp(how, "spd") == 0 && rows) {
        return make_spd(w, rows, seed, out);
    }
    if (how && strcmp(how, "any") == 0 && rows && cols) {
        *out = hn_matrix_new(w->arena, rows, cols);
        out->number = rows == 1 && cols == 1;
        if (out->x) {
            fill(out, seed);
        }
        return out->x ? HN_OK : HN_ERR_MEMORY;
    }

    // a matrix that follows from those made before
    if (how && word && strcmp(how, "null") == 0) {
        return make_null(w, word, seed, out, diag);
    }
    if (how && word && strcmp(how, "is") == 0) {
        return hn_world_eval(w, word, out, diag);
    }

    return refuse(node->string, "is none of spd, any, null, is, or its size is unknown", diag);
}

hn_status hn_world_init(hn_world *w, const hn_part *p, uint64_t seed, hn_diag *diag) {
    const cJSON *node;
    *w = (hn_world){.arena = hn_arena_create(0)};
    if (!w->arena) {
        return HN_ERR_MEMORY;
    }
    cJSON_ArrayForEach(node, cJSON_GetObjectItemCaseSensitive(p->node, "matrices")) {
        if (w->n == HN_WORLD_NAMES - 1) {
            return refuse(node->string, "is one too many", diag);
        }
        hn_matrix m;
        HN_TRY(make_one(w, p, node, seed + 1000 * (uint64_t)w->n, &m, diag));
        w->name[w->n] = node->string;
        w->matrix[w->n++] = m;
    }
    return HN_OK;
}

void hn_world_reset(hn_world *w) {
    hn_arena_free(w->arena);
    w->arena = NULL;
}

double hn_world_distance(const hn_matrix *a, const hn_matrix *b, double factor) {
    if (a->rows != b->rows || a->cols != b->cols) {
        return HUGE_VAL;
    }
    double worst = 0, size = 0;
    for (int i = 0; i < a->rows * a->cols; i++) {
        worst = fmax(worst, fabs(a->x[i] - factor * b->x[i]));
        size = fmax(size, fabs(b->x[i]));
    }
    return size > 0 ? worst / size : worst;
}

/// Rows and columns of a JSON matrix; a list of numbers is a column. 0 when rows differ.
static int measure(const cJSON *rows, int *n, int *m) {
    const cJSON *row;
    *n = cJSON_GetArraySize(rows);
    *m = cJSON_IsArray(rows ? rows->child : NULL) ? cJSON_GetArraySize(rows->child) : 1;
    cJSON_ArrayForEach(row, rows) {
        if (cJSON_IsArray(row) ? cJSON_GetArraySize(row) != *m : *m != 1) {
            return 0;
        }
    }
    return *n > 0 && *m > 0 && *n <= HN_MATRIX_LARGEST && *m <= HN_MATRIX_LARGEST;
}

/// A number, or a formula of numbers in quotes: "1/3".
static bool read_entry(hn_world *w, const cJSON *entry, double *x) {
    hn_matrix m;
    hn_diag diag;
    const char *text = cJSON_GetStringValue(entry);
    if (text && hn_world_eval(w, text, &m, &diag) == HN_OK && m.number) {
        *x = m.x[0];
        return true;
    }
    *x = cJSON_IsNumber(entry) ? entry->valuedouble : 0;
    return cJSON_IsNumber(entry);
}

int hn_world_add(hn_world *w, const char *name, const cJSON *rows, char why[HN_PART_TEXT]) {
    // rows of one length
    int n, m, i = 0;
    if (!cJSON_IsArray(rows) || !measure(rows, &n, &m)) {
        snprintf(why, HN_PART_TEXT, "%.20s is no list of rows of one length (at most %d)", name,
                 HN_MATRIX_LARGEST);
        return 0;
    }

    // the entries, row by row; a row that is no list is one entry
    hn_matrix out = hn_matrix_new(w->arena, n, m);
    const cJSON *row, *entry;
    cJSON_ArrayForEach(row, rows) {
        const cJSON *first = cJSON_IsArray(row) ? row->child : row;
        for (entry = first; entry && out.x && i < n * m;
             entry = cJSON_IsArray(row) ? entry->next : NULL) {
            if (!read_entry(w, entry, &out.x[i++])) {
                snprintf(why, HN_PART_TEXT,
                         "%.20s has an entry that is no number; write 0.5 or \"1/3\"", name);
                return 0;
            }
        }
    }

    // no memory, or no room for one more name
    if (!out.x || w->n == HN_WORLD_NAMES) {
        snprintf(why, HN_PART_TEXT, "%.20s does not fit into memory", name);
        return 0;
    }

    w->name[w->n] = name;
    w->matrix[w->n++] = out;
    return 1;
}
