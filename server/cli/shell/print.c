// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/print.h"

#include "cli/shell/fold.h"
#include "cli/shell/plain.h"
#include "terminal/width.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum { COMMAND_NOT_FOUND = 127 }; // of the shell that starts the pager

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
        fprintf(stderr, "holonom: cannot write to standard output: %s\n",
                text->failed ? hn_status_text(HN_ERR_MEMORY) : strerror(errno));
    }
    hn_strbuf_reset(text);
    return ok ? HN_EXIT_DONE : HN_EXIT_PROGRAM;
}

/// More lines than a terminal has, and somebody in front of it.
static bool wants_pager(const hn_strbuf *text) {
    struct winsize size = {0};
    int lines = 0;
    if (!isatty(STDOUT_FILENO) || !isatty(STDIN_FILENO) ||
        ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) {
        return false;
    }
    for (const char *c = hn_strbuf_text(text); *c; c++) {
        lines += *c == '\n';
    }
    return size.ws_row > 0 && lines >= size.ws_row;
}

/// Through $PAGER, or less; false: there is none, and nothing was shown.
static bool page(const hn_strbuf *text) {
    const char *pager = getenv("PAGER");
    if (pager && (!pager[0] || strcmp(pager, "cat") == 0)) {
        return false;
    }
    // what the reader leaves unread is no fault
    signal(SIGPIPE, SIG_IGN);
    setenv("LESS", "FRX", 0);
    FILE *out = popen(pager ? pager : "less", "w");
    if (!out) {
        return false;
    }
    fwrite(hn_strbuf_text(text), 1, text->n, out);
    const int status = pclose(out);
    return status != -1 && WIFEXITED(status) && WEXITSTATUS(status) != COMMAND_NOT_FOUND;
}

static hn_exit print_folded(hn_strbuf *text, int columns,
                            void (*fold)(hn_strbuf *b, const char *text, int columns)) {
    if (!text->failed && hn_plain_wanted(getenv("LC_ALL"), getenv("LC_CTYPE"), getenv("LANG"))) {
        hn_strbuf plain;
        hn_strbuf_init(&plain);
        hn_plain_text(&plain, hn_strbuf_text(text));
        hn_strbuf_reset(text);
        *text = plain;
    }
    if (!text->failed && columns > 0) {
        hn_strbuf folded;
        hn_strbuf_init(&folded);
        fold(&folded, hn_strbuf_text(text), columns);
        hn_strbuf_reset(text);
        *text = folded;
    }
    if (!text->failed && wants_pager(text) && page(text)) {
        hn_strbuf_reset(text);
        return HN_EXIT_DONE;
    }
    return hn_cli_print(text);
}

hn_exit hn_cli_print_text(hn_strbuf *text) {
    return print_folded(text, hn_terminal_limit(), hn_fold_add);
}

hn_exit hn_cli_print_prose(hn_strbuf *text) {
    const bool screen = hn_terminal_limit() > 0;
    return print_folded(text, hn_terminal_prose(), screen ? hn_fold_prose : hn_fold_paragraphs);
}
