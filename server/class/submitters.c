// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/submitters.h"

#include "base/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char METADATA[] = "submission_metadata.yml";
enum { MOST_METADATA = 256 << 20 }; ///< it holds what the autograder printed, for everybody

/// Copies a scalar of n bytes without blanks and quotes around it; an empty text where it is too
/// long.
static void copy_scalar(const char *text, size_t n, char out[HN_SUBMITTER_NAME]) {
    while (n > 0 && *text == ' ') {
        text++;
        n--;
    }
    while (n > 0 && (text[n - 1] == ' ' || text[n - 1] == '\r')) {
        n--;
    }
    if (n >= 2 && (*text == '\'' || *text == '"') && text[n - 1] == *text) {
        text++;
        n -= 2;
    }
    snprintf(out, HN_SUBMITTER_NAME, "%.*s", n < HN_SUBMITTER_NAME ? (int)n : 0, text);
}

/// Returns the value behind `key` on a line of n bytes, in a list or not; NULL: another line.
static const char *value_of(const char *line, size_t n, const char *key) {
    size_t at = 0;
    while (at < n && (line[at] == ' ' || line[at] == '-')) {
        at++;
    }
    const size_t m = strlen(key);
    return at + m <= n && strncmp(line + at, key, m) == 0 ? line + at + m : NULL;
}

static hn_status begin_entry(hn_submitters *s, const char *line, size_t n) {
    if (s->n == s->cap) {
        const int cap = s->cap ? 2 * s->cap : 64;
        hn_submitter *larger = realloc(s->list, (size_t)cap * sizeof *larger);
        if (!larger) {
            return HN_ERR_MEMORY;
        }
        s->list = larger;
        s->cap = cap;
    }
    s->list[s->n] = (hn_submitter){0};
    copy_scalar(line, n, s->list[s->n++].entry);
    return HN_OK;
}

/// The first mail address of an entry, the first name until there is one.
static void read_submitter(hn_submitter *entry, const char *line, size_t n) {
    const char *mail = value_of(line, n, ":email:"), *name = value_of(line, n, ":name:");
    const char *value = mail ? mail : name;
    char text[HN_SUBMITTER_NAME];
    if (!value || entry->has_mail || (name && entry->student[0])) {
        return;
    }
    copy_scalar(value, (size_t)(line + n - value), text);
    if (text[0]) {
        memcpy(entry->student, text, sizeof text);
        entry->has_mail = mail != NULL;
    }
}

static hn_status read_line(hn_submitters *s, const char *line, size_t n) {
    while (n > 0 && line[n - 1] == '\r') {
        n--;
    }
    const bool is_entry = n > 1 && line[n - 1] == ':' && !strchr(" -#:", line[0]);
    if (is_entry) {
        return begin_entry(s, line, n - 1);
    }
    if (s->n > 0) {
        read_submitter(&s->list[s->n - 1], line, n);
    }
    return HN_OK;
}

hn_status hn_submitters_read(hn_submitters *s, const char *folder, hn_diag *diag) {
    char path[1100];
    *s = (hn_submitters){0};
    const int n = snprintf(path, sizeof path, "%s/%s", folder, METADATA);
    if (n >= (int)sizeof path || access(path, F_OK) != 0) {
        return HN_OK;
    }

    // line by line
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = hn_file_read(path, MOST_METADATA, &text, diag);
    const char *at = hn_strbuf_text(&text);
    while (status == HN_OK && *at) {
        const size_t length = strcspn(at, "\n");
        status = read_line(s, at, length);
        at += length + (at[length] == '\n');
    }
    hn_strbuf_reset(&text);
    return status;
}

const char *hn_submitters_find(const hn_submitters *s, const char *entry) {
    for (int i = 0; i < s->n; i++) {
        if (s->list[i].student[0] && strcmp(s->list[i].entry, entry) == 0) {
            return s->list[i].student;
        }
    }
    return NULL;
}

void hn_submitters_reset(hn_submitters *s) {
    free(s->list);
    *s = (hn_submitters){0};
}
