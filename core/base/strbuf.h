// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_STRBUF_H
#define HN_BASE_STRBUF_H
// A growing text with one sticky error flag, and on it a JSON writer: commas and nesting are kept
// by the buffer; numbers are written with 17 significant digits (shortest text that reads back to
// the same double is allowed); a number that is not finite is written as null, so that JSON never
// holds NaN or Infinity.

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

typedef struct hn_strbuf {
    char *text; ///< always zero-terminated once anything was written; NULL while empty
    size_t n;   ///< bytes, without the zero
    size_t cap;
    int failed;        ///< memory ran out: everything after that is ignored
    int depth;         ///< JSON nesting
    uint64_t has_item; ///< bit per depth: a comma is due
    int after_key;
} hn_strbuf;

/// An empty buffer; it allocates nothing yet.
void hn_strbuf_init(hn_strbuf *b);
void hn_strbuf_reset(hn_strbuf *b); ///< frees the text; the buffer can be used again
void hn_strbuf_clear(hn_strbuf *b); ///< keeps the memory, forgets the text
/// returns owned text (free()), buffer is empty again; NULL if failed
char *hn_strbuf_take(hn_strbuf *b);
const char *hn_strbuf_text(const hn_strbuf *b); ///< never NULL ("" while empty)
void hn_strbuf_add(hn_strbuf *b, const char *text);
void hn_strbuf_add_n(hn_strbuf *b, const char *bytes, size_t n);
void hn_strbuf_printf(hn_strbuf *b, const char *format, ...) HN_PRINTF(2, 3);

// JSON: values are placed in the open object or array; keys only in objects.
void hn_json_object(hn_strbuf *b);
void hn_json_end_object(hn_strbuf *b);
void hn_json_array(hn_strbuf *b);
void hn_json_end_array(hn_strbuf *b);
void hn_json_key(hn_strbuf *b, const char *key);
void hn_json_number(hn_strbuf *b, double value);
void hn_json_int(hn_strbuf *b, long long value);
void hn_json_bool(hn_strbuf *b, int value);
void hn_json_null(hn_strbuf *b);
/// Escaped; NULL becomes null; bytes that are not UTF-8 become U+FFFD.
void hn_json_string(hn_strbuf *b, const char *text);
void hn_json_raw(hn_strbuf *b, const char *json);                   ///< already valid JSON
void hn_json_numbers(hn_strbuf *b, const double *values, size_t n); ///< an array
void hn_json_strings(hn_strbuf *b, const char *const *values, size_t n);
// key + value in one call
void hn_json_put_number(hn_strbuf *b, const char *key, double value);
void hn_json_put_int(hn_strbuf *b, const char *key, long long value);
void hn_json_put_bool(hn_strbuf *b, const char *key, int value);
void hn_json_put_string(hn_strbuf *b, const char *key, const char *text);
void hn_json_put_numbers(hn_strbuf *b, const char *key, const double *values, size_t n);
/// {"status","pointer","detail","hint"[,"column"]} for one fault, an array of them for a list.
struct hn_diag;
struct hn_diags;
void hn_json_diags(hn_strbuf *b, const struct hn_diags *d);
#endif
