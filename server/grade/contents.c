// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/contents.h"

#include "base/hash.h"
#include "base/json_text.h"

#include <stdlib.h>
#include <string.h>

/// The hash with one member of the file taken in; a member that is not there counts as none.
static uint64_t take(uint64_t hash, const cJSON *node) {
    char *text = node ? cJSON_PrintUnformatted(node) : NULL;
    hash = hn_hash_text(hash, text ? text : "");
    cJSON_free(text);
    return hash;
}

static uint64_t take_two(const cJSON *root, const char *first, const char *second) {
    const uint64_t hash = take(HN_HASH_START, cJSON_GetObjectItemCaseSensitive(root, first));
    return hn_hash_mix(take(hash, cJSON_GetObjectItemCaseSensitive(root, second)));
}

void hn_contents_read(hn_contents *c, const cJSON *root) {
    const cJSON *part;
    *c = (hn_contents){.statement = take_two(root, "title", "statement"),
                       .numbers = take_two(root, "draw", "conditions")};
    if (!cJSON_GetObjectItemCaseSensitive(root, "parts")) {
        const uint64_t from = take_two(root, "parameters", "coordinates");
        c->numbers = hn_hash_mix(from ^ take_two(root, "states", "aliases"));
        c->equations = take_two(root, "phi", "answer");
        c->judging = take_two(root, "tolerance", "partial");
    }
    cJSON_ArrayForEach(part, cJSON_GetObjectItemCaseSensitive(root, "parts")) {
        if (c->n_parts < HN_CONTENTS_PARTS) {
            c->part[c->n_parts++] = hn_hash_mix(take(HN_HASH_START, part));
        }
    }
}

static void put_hash(hn_strbuf *b, const char *name, uint64_t hash) {
    char hex[17];
    hn_hash_hex(hash, hex);
    hn_json_put_string(b, name, hex);
}

void hn_contents_put(hn_strbuf *b, const hn_contents *c, const hn_part *parts) {
    hn_json_key(b, "contents");
    hn_json_object(b);
    put_hash(b, "statement", c->statement);
    put_hash(b, "numbers", c->numbers);
    if (c->n_parts == 0) {
        put_hash(b, "equations", c->equations);
        put_hash(b, "judging", c->judging);
        hn_json_end_object(b);
        return;
    }
    hn_json_key(b, "parts");
    hn_json_object(b);
    for (int i = 0; i < c->n_parts; i++) {
        put_hash(b, parts[i].id, c->part[i]);
    }
    hn_json_end_object(b);
    hn_json_end_object(b);
}

static bool is_same(const cJSON *old, const char *name, uint64_t hash) {
    char hex[17];
    hn_hash_hex(hash, hex);
    const char *was = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(old, name));
    return was && strcmp(was, hex) == 0;
}

static void add_change(hn_strbuf *b, size_t start, const char *what, const char *id,
                       const char *how) {
    hn_strbuf_printf(b, "%s%s%.40s%s", b->n > start ? ", " : "", what, id, how);
}

void hn_contents_put_changes(hn_strbuf *b, const hn_contents *c, const hn_part *parts,
                             const cJSON *old) {
    const cJSON *olds = cJSON_GetObjectItemCaseSensitive(old, "parts"), *one;
    const size_t start = b->n;
    const bool is_matrix = c->n_parts == 0;
    if (is_matrix ? !cJSON_GetObjectItemCaseSensitive(old, "equations") : !cJSON_IsObject(olds)) {
        return; // an older verdict
    }
    if (!is_same(old, "statement", c->statement)) {
        add_change(b, start, "its statement", "", "");
    }
    if (!is_same(old, "numbers", c->numbers)) {
        add_change(b, start, "how its numbers are drawn", "", "");
    }
    if (is_matrix && !is_same(old, "equations", c->equations)) {
        add_change(b, start, "its equations or what is asked", "", "");
    }
    if (is_matrix && !is_same(old, "judging", c->judging)) {
        add_change(b, start, "its tolerance or the shares of mistakes", "", "");
    }
    for (int i = 0; i < c->n_parts; i++) {
        if (!cJSON_GetObjectItemCaseSensitive(olds, parts[i].id)) {
            add_change(b, start, "part ", parts[i].id, " (new)");
        } else if (!is_same(olds, parts[i].id, c->part[i])) {
            add_change(b, start, "part ", parts[i].id, "");
        }
    }

    // parts of then that are no longer there
    cJSON_ArrayForEach(one, olds) {
        bool found = false;
        for (int i = 0; i < c->n_parts; i++) {
            found |= strcmp(parts[i].id, one->string) == 0;
        }
        if (!found) {
            add_change(b, start, "part ", one->string, " (gone)");
        }
    }
}
