// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/closing_head.h"

#include "build.h"

#include <strings.h>

void hn_closing_head_put(hn_strbuf *b, unsigned status, const char *media_type, size_t n_body) {
    hn_strbuf_printf(b,
                     "HTTP/1.1 %u \r\nContent-Type: %s\r\nContent-Length: %zu\r\n"
                     "Connection: close\r\nHolonom-Build: %s\r\n"
                     "X-Content-Type-Options: nosniff\r\nCache-Control: no-store\r\n",
                     status, media_type, n_body, hn_build_name());
}

bool hn_closing_head_has(const char *name) {
    static const char *const names[] = {"Content-Type",  "Content-Length",         "Connection",
                                        "Holonom-Build", "X-Content-Type-Options", "Cache-Control"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcasecmp(name, names[i]) == 0) {
            return true;
        }
    }
    return false;
}
