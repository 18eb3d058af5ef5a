// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/print.h"

#include "cli/shell/plain.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

hn_exit hn_cli_print(hn_strbuf *text) {
    int ok = !text->failed;
    if (ok) {
        ok = fwrite(hn_strbuf_text(text), 1, text->n, stdout) == text->n;
        if (ok && text->n > 0 && text->text[text->n - 1] != '\n') {
            ok = fputc('\n', stdout) != EOF;
        }
        ok = ok && fflush(stdout) == 0;
    }
    if (!ok) {
        fprintf(stderr, "holonom: %s\n",
                text->failed ? hn_status_text(HN_ERR_MEMORY) : strerror(errno));
    }
    hn_strbuf_reset(text);
    return ok ? HN_EXIT_DONE : HN_EXIT_PROGRAM;
}

hn_exit hn_cli_print_text(hn_strbuf *text) {
    if (!text->failed && hn_plain_wanted(getenv("LC_ALL"), getenv("LC_CTYPE"), getenv("LANG"))) {
        hn_strbuf plain;
        hn_strbuf_init(&plain);
        hn_plain_add(&plain, hn_strbuf_text(text));
        hn_strbuf_reset(text);
        *text = plain;
    }
    return hn_cli_print(text);
}
