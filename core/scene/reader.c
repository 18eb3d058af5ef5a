// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/reader.h"

#include "base/strbuf.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// ---- where we are, what is wrong ----

size_t hn_rd_enter(hn_reader *r, const char *key) {
    size_t mark = strlen(r->path), at = mark;
    if (at + 1 < sizeof r->path) {
        r->path[at++] = '/';
    }
    for (const char *c = key; *c && at + 2 < sizeof r->path; c++) {
        if (*c == '~' || *c == '/') {
            r->path[at++] = '~';
            r->path[at++] = *c == '~' ? '0' : '1';
        } else {
            r->path[at++] = *c;
        }
    }
    r->path[at] = '\0';
    return mark;
}

size_t hn_rd_enter_index(hn_reader *r, int index) {
    char key[16];
    snprintf(key, sizeof key, "%d", index);
    return hn_rd_enter(r, key);
}

void hn_rd_leave(hn_reader *r, size_t mark) {
    r->path[mark] = '\0';
}

static bool add_fault(hn_reader *r, hn_status status, const char *hint, const char *format,
                      va_list args) {
    char message[HN_DIAG_MESSAGE], where[HN_RD_MAX_NAME + 48] = "";
    vsnprintf(message, sizeof message, format, args);
    if (r->loop_name) {
        snprintf(where, sizeof where, " (at %s = %lld)", r->loop_name, r->loop_value);
    }
    hn_diags_add(r->diags, status, r->path, hint, "%s%s", message, where);
    if (r->n_faults++ == 0) {
        r->status = status;
    }
    return false;
}

bool hn_rd_fault(hn_reader *r, const char *hint, const char *format, ...) {
    va_list args;
    va_start(args, format);
    add_fault(r, HN_ERR_INPUT, hint, format, args);
    va_end(args);
    return false;
}

bool hn_rd_fault_at(hn_reader *r, const char *key, const char *hint, const char *format, ...) {
    va_list args;
    size_t mark = hn_rd_enter(r, key);
    va_start(args, format);
    add_fault(r, HN_ERR_INPUT, hint, format, args);
    va_end(args);
    hn_rd_leave(r, mark);
    return false;
}

bool hn_rd_limit(hn_reader *r, const char *format, ...) {
    va_list args;
    va_start(args, format);
    add_fault(r, HN_ERR_LIMIT, NULL, format, args);
    va_end(args);
    return false;
}

bool hn_rd_stopped(const hn_reader *r) {
    return r->oom || r->n_faults >= HN_RD_MAX_FAULTS;
}

void hn_rd_suggest(char *out, size_t size, const char *word, const char *const *names, int n) {
    // any letter is near any other
    const char *near = strlen(word) > 1 ? hn_nearest_name(word, names, n) : NULL;
    if (near) {
        snprintf(out, size, "did you mean '%s'?", near);
        return;
    }
    size_t at = (size_t)snprintf(out, size, n > 0 ? "allowed: " : "none is known here");
    for (int i = 0; i < n && at + 4 < size; i++) {
        at += (size_t)snprintf(out + at, size - at, i ? ", %s" : "%s", names[i]);
    }
}

const char *hn_rd_kind(const cJSON *node) {
    return !node                  ? "nothing"
           : cJSON_IsNumber(node) ? "a number"
           : cJSON_IsString(node) ? "a text"
           : cJSON_IsArray(node)  ? "a list"
           : cJSON_IsObject(node) ? "an object"
           : cJSON_IsTrue(node)   ? "true"
           : cJSON_IsFalse(node)  ? "false"
                                  : "null";
}

// ---- memory ----

void *hn_rd_grow(hn_reader *r, void *items, int n, size_t size, int limit, const char *what) {
    if (n >= limit) {
        hn_rd_limit(r, "more than the %d %s allowed", limit, what);
        r->n_faults = HN_RD_MAX_FAULTS;
        return NULL;
    }
    // full exactly when n is 0, 8, 16, 32, ...
    int full = n == 0 || (n >= 8 && (n & (n - 1)) == 0);
    if (!full) {
        return items;
    }
    void *more = hn_arena_get(r->arena, size * (size_t)(n == 0 ? 8 : 2 * n));
    if (!more) {
        r->oom = true;
        return NULL;
    }
    if (n > 0) {
        memcpy(more, items, size * (size_t)n);
    }
    return more;
}

const char *hn_rd_keep(hn_reader *r, const char *text) {
    const char *copy = hn_arena_strdup(r->arena, text);
    if (text && !copy) {
        r->oom = true;
    }
    return copy;
}

const char *hn_rd_pointer(hn_reader *r) {
    return hn_rd_keep(r, r->path);
}

// ---- the tree ----

const cJSON *hn_rd_get(const cJSON *object, const char *key) {
    return cJSON_IsObject(object) ? cJSON_GetObjectItemCaseSensitive(object, key) : NULL;
}

bool hn_rd_object(hn_reader *r, const cJSON *node, const char *what, const char *const *fields,
                  int n_fields) {
    if (!cJSON_IsObject(node)) {
        return hn_rd_fault(r, NULL, "expected an object for %s, found %s", what, hn_rd_kind(node));
    }
    for (const cJSON *m = node->child; m && !hn_rd_stopped(r); m = m->next) {
        bool known = 0;
        for (int i = 0; i < n_fields && !known; i++) {
            known = strcmp(m->string, fields[i]) == 0;
        }
        if (!known) {
            char hint[HN_DIAG_HINT];
            hn_rd_suggest(hint, sizeof hint, m->string, fields, n_fields);
            hn_rd_fault_at(r, m->string, hint, "unknown field '%.60s' in %s", m->string, what);
        }
    }
    return true;
}

int hn_rd_one_kind(hn_reader *r, const cJSON *node, const char *what, const char *const *kinds,
                   int n) {
    const char *fields[HN_RD_MAX_KINDS + 2] = {"name", "for"};
    char a_what[HN_RD_MAX_NAME], allowed[HN_DIAG_HINT];
    HN_ASSERT(n <= HN_RD_MAX_KINDS);

    // the member that names the kind, and how many there are
    int kind = -1, found = 0;
    size_t used = (size_t)snprintf(allowed, sizeof allowed, "allowed: ");
    for (int k = 0; k < n; k++) {
        fields[k + 2] = kinds[k];
        used += (size_t)snprintf(allowed + used, sizeof allowed - used, "%s%s", k ? ", " : "",
                                 kinds[k]);
        if (hn_rd_get(node, kinds[k])) {
            kind = k;
            found++;
        }
    }

    // what else there is, then no kind or two at once
    const int faults = r->n_faults;
    snprintf(a_what, sizeof a_what, "a %s", what);
    if (!hn_rd_object(r, node, a_what, fields, n + 2)) {
        return -1;
    }
    if (found != 1 && r->n_faults == faults) {
        hn_rd_fault(r, allowed, "expected one kind of %s, found %d", what, found);
    }
    return found == 1 ? kind : -1;
}

bool hn_rd_is_list(hn_reader *r, const cJSON *node, const char *what) {
    return !node || cJSON_IsArray(node) ||
           hn_rd_fault(r, NULL, "expected a list of %s, found %s", what, hn_rd_kind(node));
}

/// One bound of a repetition: a whole number.
static bool read_bound(hn_reader *r, const cJSON *node, int index, long long *out) {
    size_t mark = hn_rd_enter_index(r, index);
    hn_quantity q;
    r->mark_structural = true;
    bool ok = hn_rd_quantity(r, node, &q, HN_RD_CONST);
    r->mark_structural = false;
    if (ok && !(fabs(q.value) <= 1e6 && q.value == floor(q.value))) {
        ok = hn_rd_fault(r, NULL, "expected a whole number up to a million, found %g", q.value);
    }
    *out = ok ? (long long)q.value : 0;
    hn_rd_leave(r, mark);
    return ok;
}

/// The member "for" of an item: {"i": [first, last]}, both included.
static bool read_for(hn_reader *r, const cJSON *node, const char **name, long long bounds[2]) {
    const cJSON *range = cJSON_IsObject(node) ? node->child : NULL;
    if (!range || range->next) {
        return hn_rd_fault(
            r, "as in {\"i\": [1, \"N\"]}",
            "expected an object with one name and its first and last value, found %s",
            cJSON_IsObject(node) ? (range ? "several names" : "an empty object")
                                 : hn_rd_kind(node));
    }

    // the name of the repetition, then its two bounds
    size_t mark = hn_rd_enter(r, range->string);
    bool ok = hn_rd_check_identifier(r, range->string);
    if (cJSON_GetArraySize(range) != 2 || !cJSON_IsArray(range)) {
        ok = hn_rd_fault(r, "as in [1, \"N\"]", "expected the first and the last value, found %s",
                         hn_rd_kind(range));
    } else {
        ok &= read_bound(r, range->child, 0, &bounds[0]);
        ok &= read_bound(r, range->child->next, 1, &bounds[1]);
    }

    // a bound far too high is a slip of the pen
    if (ok && bounds[1] - bounds[0] >= HN_RD_MAX_REPEAT) {
        ok = hn_rd_limit(r, "more than the %d repetitions allowed", HN_RD_MAX_REPEAT);
    }
    hn_rd_leave(r, mark);
    *name = range->string;
    return ok;
}

static void repeat(hn_reader *r, const cJSON *node, const char *key, hn_rd_item item) {
    const cJSON *loop = hn_rd_get(node, "for");
    if (!loop) {
        item(r, node, key);
        return;
    }

    // the range, read at its own place
    long long bounds[2] = {0, -1};
    const char *name = NULL;
    size_t mark = hn_rd_enter(r, "for");
    bool ok = read_for(r, loop, &name, bounds);
    hn_rd_leave(r, mark);
    if (!ok) {
        return;
    }

    // one item for each value
    int faults = r->n_faults;
    r->loop_name = name;
    // one faulty repetition is enough
    for (long long i = bounds[0]; i <= bounds[1] && r->n_faults == faults && !r->oom; i++) {
        r->loop_value = i;
        item(r, node, key);
    }
    r->loop_name = NULL;
}

void hn_rd_each(hn_reader *r, const cJSON *node, hn_rd_item item) {
    int index = 0;
    for (const cJSON *m = node ? node->child : NULL; m && !hn_rd_stopped(r); m = m->next, index++) {
        size_t mark =
            cJSON_IsObject(node) ? hn_rd_enter(r, m->string) : hn_rd_enter_index(r, index);
        repeat(r, m, cJSON_IsObject(node) ? m->string : NULL, item);
        hn_rd_leave(r, mark);
    }
}

void hn_rd_list(hn_reader *r, const cJSON *node, const char *key, int object, hn_rd_item item) {
    const cJSON *list = hn_rd_get(node, key);
    size_t mark = hn_rd_enter(r, key);
    if (list && (object ? !cJSON_IsObject(list) : !cJSON_IsArray(list))) {
        hn_rd_fault(r, NULL, "expected %s, found %s", object ? "an object" : "a list",
                    hn_rd_kind(list));
    } else if (list) {
        hn_rd_each(r, list, item);
    }
    hn_rd_leave(r, mark);
}
