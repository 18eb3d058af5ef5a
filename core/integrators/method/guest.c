// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/method/guest.h"

#include <string.h>

static hn_guest_finder finder; // both set once, at the start of the process
static hn_guest_lister lister;

void hn_guest_serve(hn_guest_finder wanted, hn_guest_lister list) {
    finder = wanted;
    lister = list;
}

void hn_guest_list(hn_strbuf *b) {
    if (lister) {
        lister(b);
    }
}

bool hn_guest_is_named(const char *spelling) {
    return strncmp(spelling, HN_GUEST_PREFIX, strlen(HN_GUEST_PREFIX)) == 0;
}

hn_status hn_guest_find(const char *name, hn_guest *out, hn_diag *diag) {
    if (!finder) {
        return hn_diag_set(
            diag, HN_ERR_INPUT, NULL, "--allow-programs allows them; serve takes --programs DIR",
            "'%.100s' is an external program, and such programs are not allowed here", name);
    }
    return finder(name, out, diag);
}
