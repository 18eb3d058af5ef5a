// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STORED_JSON_H
#define HN_SESSION_STORED_JSON_H
// Reads back JSON that the program has written. Each reader returns 1 when the member exists and
// has the expected type and size. A null is read as NaN.

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/// Returns the whole text of the file, owned by the caller; NULL when it cannot be read or is above
/// 256 MB.
char *hn_stored_text_of(FILE *f, size_t *n);
/// Returns the object in a file, owned by the caller; NULL without a file or without valid JSON.
cJSON *hn_stored_open(const char *path);
bool hn_stored_number(const cJSON *object, const char *key, double *out);
/// Reads a whole number, 0 <= *out < below.
bool hn_stored_int(const cJSON *object, const char *key, int below, int *out);
/// Reads a list of exactly n numbers.
bool hn_stored_numbers(const cJSON *object, const char *key, double *out, size_t n);
bool hn_stored_text(const cJSON *object, const char *key, char *out, size_t size);
#endif
