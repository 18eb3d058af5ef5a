// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_PROMISES_H
#define HN_HTTP_PROMISES_H
// Who was refused and told to come back, and when: whoever is refused next is told a later time,
// because one place that becomes free is enough for one of them only.

#include "http/ground/shares.h"

#include <stdint.h>

enum { HN_PROMISES = 256 };

typedef struct hn_promise {
    hn_client client;
    uint64_t key; ///< of what was asked for; 0: unknown
    double due;   ///< [s, wall clock]
} hn_promise;

typedef struct hn_promises {
    int n;
    hn_promise item[HN_PROMISES]; ///< oldest first; when all are in use no more are written down
} hn_promises;

/// Returns how many were promised a place before `key`, and are not due yet: of one client, or of
/// all where `client` is NULL. Forgets those that are due.
int hn_promises_ahead(hn_promises *p, const hn_client *client, uint64_t key, double now);
/// Writes down a promise. A `key` (not 0) that has one keeps its place among them.
void hn_promises_make(hn_promises *p, hn_client client, uint64_t key, double due);
/// Forgets the promise for `key`, which has its place now. 0 has none.
void hn_promises_end(hn_promises *p, uint64_t key);
#endif
