#ifndef HN_HTTP_JSON_SCAN_H
#define HN_HTTP_JSON_SCAN_H
// A strict look at a text before it is parsed: JSON as RFC 8259 has it, UTF-8 as RFC 3629 has it, no
// number beyond a double. The parser behind it is more lenient and says less about where a fault lies.

#include <stddef.h>

enum { HN_JSON_MAX_DEPTH = 64 };

typedef struct hn_json_fault {
    size_t offset;    ///< byte at which the text stops being JSON
    const char *what; ///< one clause; static text
} hn_json_fault;

/// 1 when the n bytes are one JSON value; otherwise 0 and `fault` is filled.
int hn_json_scan(const char *text, size_t n, hn_json_fault *fault);
#endif
