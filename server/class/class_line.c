// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/class_line.h"

#include "base/hash.h"

#include <stdio.h>
#include <string.h>

static const char CHECK[] = ",\"check\":";

/// The hash of what a line says of its submission: its status, and all from its file on. The place
/// of a part in the class is left out. Quotes within texts are escaped, so that the marks are found
/// nowhere else.
static void hash_line(const char *line, size_t n, char hex[17]) {
    static const char *const FIELDS[] = {",\"status\":", ",\"file\":"};
    const char *status = strstr(line, FIELDS[0]), *file = strstr(line, FIELDS[1]);
    const char *status_end = status ? strchr(status + 1, ',') : NULL;
    uint64_t hash = HN_HASH_START;
    if (status_end && file && file < line + n) {
        hash = hn_hash_bytes(hash, status, (size_t)(status_end - status));
        hash = hn_hash_bytes(hash, file, (size_t)(line + n - file));
    }
    hn_hash_hex(hn_hash_mix(hash), hex);
}

void hn_class_line_put_check(hn_strbuf *b) {
    char hex[17];
    hash_line(hn_strbuf_text(b), b->n, hex);
    hn_json_put_string(b, "check", hex);
}

bool hn_class_line_is_unchanged(const char *line, const cJSON *o) {
    char hex[17];
    const char *said = cJSON_GetStringValue(cJSON_GetObjectItem(o, "check"));
    const char *end = strstr(line, CHECK);
    if (!said || !end) {
        return false;
    }
    hash_line(line, (size_t)(end - line), hex);
    return strcmp(said, hex) == 0;
}

/// Returns whether two entries are of one matrix or of one part.
static bool are_of_one(const hn_entry_verdict *a, const hn_entry_verdict *b) {
    return a->n_whole == b->n_whole && strncmp(a->name, b->name, (size_t)a->n_whole) == 0;
}

/// "sign in J11". A matrix that is transposed is one mistake of the whole: "transposed in J"; its
/// right entries have it too.
static void put_mistake(hn_strbuf *b, const hn_verdict *v, int k) {
    const hn_entry_verdict *e = &v->entry[k], *before = k > 0 ? e - 1 : NULL;
    if (!e->mistake || !e->mistake[0]) {
        return;
    }
    char what[80];
    const bool whole = strcmp(e->mistake, "transposed") == 0;
    const int n = whole ? e->n_whole : (int)strlen(e->name);
    for (; whole && before && before >= v->entry; before--) {
        if (strcmp(before->mistake, e->mistake) == 0 && are_of_one(before, e)) {
            return; // named by an entry before
        }
    }
    snprintf(what, sizeof what, "%s in %.*s", e->mistake, n, e->name);
    hn_json_string(b, what);
}

void hn_class_line_put_mistakes(hn_strbuf *b, const hn_verdict *v) {
    hn_json_key(b, "mistakes");
    hn_json_array(b);
    for (int k = 0; k < v->n_entries; k++) {
        put_mistake(b, v, k);
    }
    hn_json_end_array(b);
}
