// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/repeated_member.h"

#include <string.h>

/// The next member behind `m` with the same name; NULL: there is none.
static cJSON *find_same(const cJSON *m) {
    cJSON *next = m->next;
    while (next && strcmp(next->string, m->string) != 0) {
        next = next->next;
    }
    return next;
}

int hn_repeated_member_count(const cJSON *node) {
    int most = cJSON_IsObject(node) ? cJSON_GetArraySize(node) : 0;
    for (const cJSON *m = node ? node->child : NULL; m; m = m->next) {
        const int below = hn_repeated_member_count(m);
        most = below > most ? below : most;
    }
    return most;
}

/// Removes the members behind `m` that have its name and, written out, its value.
static int drop_same(cJSON *object, const cJSON *m) {
    int dropped = 0;
    cJSON *same = find_same(m);
    char *value = same ? cJSON_PrintUnformatted(m) : NULL;
    while (same) {
        cJSON *next = find_same(same);
        char *other = cJSON_PrintUnformatted(same);
        if (value && other && strcmp(value, other) == 0) {
            cJSON_Delete(cJSON_DetachItemViaPointer(object, same));
            dropped++;
        }
        cJSON_free(other);
        same = next;
    }
    cJSON_free(value);
    return dropped;
}

int hn_repeated_member_drop(cJSON *node) {
    int dropped = 0;
    for (cJSON *m = node ? node->child : NULL; m; m = m->next) {
        dropped += hn_repeated_member_drop(m);
    }
    for (cJSON *m = cJSON_IsObject(node) ? node->child : NULL; m; m = m->next) {
        dropped += drop_same(node, m);
    }
    return dropped;
}

bool hn_repeated_member_is(const cJSON *object, const char *name) {
    const cJSON *first = cJSON_GetObjectItemCaseSensitive(object, name);
    return first && find_same(first);
}

const char *hn_repeated_member_find(const cJSON *node) {
    const char *found = NULL;
    for (const cJSON *m = node ? node->child : NULL; m && !found; m = m->next) {
        const bool repeats = cJSON_IsObject(node) && find_same(m);
        found = repeats ? m->string : hn_repeated_member_find(m);
    }
    return found;
}
