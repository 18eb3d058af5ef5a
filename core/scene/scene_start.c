// SPDX-License-Identifier: GPL-3.0-or-later
// The start of a run, of either kind of scene: values that are kept, guesses, the assembly mode
// asked for.

#include "scene/reader.h"
#include "scene/scene_refs.h"

#include <string.h>

/// A start entry: a number or formula is pinned, {"guess": ..} is where assembly begins.
static bool read_entry(hn_reader *r, const cJSON *node, hn_quantity *q, int *pinned) {
    static const char *const fields[] = {"value", "guess", "for"};
    *pinned = 1;
    if (!cJSON_IsObject(node)) {
        return hn_rd_quantity(r, node, q, HN_RD_CONST);
    }
    if (!hn_rd_object(r, node, "a start value", fields, 3)) {
        return false;
    }
    const cJSON *value = hn_rd_get(node, "value"), *guess = hn_rd_get(node, "guess");
    if (!value == !guess) {
        return hn_rd_fault(r, "assembly keeps a 'value' and starts from a 'guess'",
                           "expected either 'value' or 'guess', found %s",
                           value ? "both" : "neither");
    }
    *pinned = value != NULL;
    return hn_rd_member(r, node, value ? "value" : "guess", 1, 0, q, HN_RD_CONST);
}

/// The parameter that an entry names and nothing else; NULL for a number or a longer formula.
static const char *named_parameter(hn_reader *r, const cJSON *node) {
    const cJSON *value = hn_rd_get(node, "value");
    const cJSON *text = cJSON_IsObject(node) ? value : node;
    const int k = cJSON_IsString(text) ? hn_scene_find_param(r->scene, text->valuestring) : -1;
    return k >= 0 ? r->scene->params[k].name : NULL;
}

static hn_coordinate *start_coordinate(hn_reader *r, const char *key) {
    const char *name = hn_rd_fill(r, key);
    int k = name ? hn_rd_coordinate(r, name, 1) : -1;
    return k >= 0 ? &r->scene->coordinates[k] : NULL;
}

static void read_position(hn_reader *r, const cJSON *node, const char *key) {
    hn_quantity q;
    int pinned;
    hn_coordinate *c = start_coordinate(r, key);
    if (!c || !read_entry(r, node, &q, &pinned)) {
        return;
    }
    if (c->q0_given) {
        hn_rd_fault(r, NULL, "the start of '%s' is given twice", c->name);
        return;
    }
    c->q0 = q.value;
    c->q0_given = true;
    c->q0_pinned = pinned;
    c->q0_pointer = hn_rd_pointer(r);
    c->q0_param = named_parameter(r, node);
}

static void read_rate(hn_reader *r, const cJSON *node, const char *key) {
    hn_quantity q;
    int pinned;
    hn_coordinate *c = start_coordinate(r, key);
    if (!c || !read_entry(r, node, &q, &pinned)) {
        return;
    }
    if (c->v0_given) {
        hn_rd_fault(r, NULL, "the start rate of '%s' is given twice", c->name);
        return;
    }
    c->v0 = q.value;
    c->v0_given = true;
    c->v0_pinned = pinned;
    c->v0_pointer = hn_rd_pointer(r);
    c->v0_param = named_parameter(r, node);
}

/// A state to start from instead, such as one that a person dragged the mechanism to: every value
/// replaces that of its coordinate or rate, and assembly begins there.
static void read_moved(hn_reader *r, const cJSON *node, const char *key) {
    hn_quantity q;
    hn_coordinate *c = start_coordinate(r, key);
    if (!c || !hn_rd_quantity(r, node, &q, HN_RD_CONST)) {
        return;
    }
    if (strcmp(key, c->name) == 0) {
        c->q0 = q.value;
        c->q0_given = true;
        c->q0_pinned = false;
        c->q0_pointer = hn_rd_pointer(r);
    } else {
        c->v0 = q.value;
        c->v0_given = true;
        c->v0_pinned = false;
        c->v0_pointer = hn_rd_pointer(r);
    }
}

/// "open", "crossed", or a sign for each loop.
static void read_mode(hn_reader *r, const cJSON *node) {
    static const char *const words[] = {"open", "crossed", "+", "-"};
    const char *mode = hn_rd_text(r, node, "mode", 0);
    if (!mode || strcmp(mode, words[0]) == 0 || strcmp(mode, words[1]) == 0) {
        r->scene->mode = mode;
        return;
    }
    size_t n = strspn(mode, "+-");
    if (n == 0 || mode[n] != '\0' || n > HN_SCENE_MAX_JOINTS) {
        char hint[HN_DIAG_HINT];
        hn_rd_suggest(hint, sizeof hint, mode, words, 4);
        hn_rd_fault_at(r, "mode", hint,
                       "unknown assembly mode '%.60s'; several loops have a sign each, as in '+-+'",
                       mode);
        return;
    }
    r->scene->mode = mode;
}

void hn_rd_start(hn_reader *r, const cJSON *root) {
    static const char *const fields[] = {"positions", "rates", "moved", "mode"};
    const cJSON *node = hn_rd_get(root, "start");
    if (!node) {
        return;
    }
    size_t mark = hn_rd_enter(r, "start");
    if (hn_rd_object(r, node, "a start", fields, 4)) {
        hn_rd_list(r, node, "positions", 1, read_position);
        hn_rd_list(r, node, "rates", 1, read_rate);
        hn_rd_list(r, node, "moved", 1, read_moved);
        read_mode(r, node);
    }
    hn_rd_leave(r, mark);
}
