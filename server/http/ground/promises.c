// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/promises.h"

/// Returns the index of a promise, or how many there are.
static int find(const hn_promises *p, uint64_t key) {
    int i = 0;
    while (i < p->n && (key == 0 || p->item[i].key != key)) {
        i++;
    }
    return i;
}

int hn_promises_ahead(hn_promises *p, const hn_client *client, uint64_t key, double now) {
    int n = 0, ahead = 0;
    for (int i = 0; i < p->n; i++) {
        if (p->item[i].due > now) {
            p->item[n++] = p->item[i];
        }
    }
    p->n = n;

    const int own = find(p, key);
    for (int i = 0; i < own; i++) {
        ahead += !client || p->item[i].client == *client;
    }
    return ahead;
}

void hn_promises_make(hn_promises *p, hn_client client, uint64_t key, double due) {
    const int i = find(p, key);
    if (i < HN_PROMISES) {
        p->item[i] = (hn_promise){.client = client, .key = key, .due = due};
        p->n += i == p->n;
    }
}

void hn_promises_end(hn_promises *p, uint64_t key) {
    const int own = find(p, key);
    if (own < p->n) {
        p->n--;
        for (int i = own; i < p->n; i++) {
            p->item[i] = p->item[i + 1];
        }
    }
}
