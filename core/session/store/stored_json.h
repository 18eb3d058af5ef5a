// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STORED_JSON_H
#define HN_SESSION_STORED_JSON_H
// Reading back what the program has written as JSON: each returns 1 when the member is there and
// fits. A null is a NaN that was written.

#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdio.h>

/// The whole text, owned; NULL when there is none or it is larger than 256 MB.
char *hn_stored_text_of(FILE *f, size_t *n);
/// The object in a file, owned; NULL: no file, or no JSON.
cJSON *hn_stored_open(const char *path);
int hn_stored_number(const cJSON *object, const char *key, double *out);
/// A whole number from 0 to below.
int hn_stored_int(const cJSON *object, const char *key, int below, int *out);
/// Exactly n of them.
int hn_stored_numbers(const cJSON *object, const char *key, double *out, size_t n);
int hn_stored_text(const cJSON *object, const char *key, char *out, size_t size);
#endif
