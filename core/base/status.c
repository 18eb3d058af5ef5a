// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/status.h"

#include <stdbool.h>
#include <stdio.h>

static const struct {
    const char *name, *text;
} statuses[HN_STATUS_COUNT] = {
#define HN_STATUS_ROW(value, name, text) {name, text},
    HN_STATUS_LIST(HN_STATUS_ROW)
#undef HN_STATUS_ROW
};

// The one place in core/ that prints and ends the program: the caller broke a contract, so no
// status could be trusted to be looked at.
_Noreturn void hn_assert_failed(const char *cond, const char *file, int line) {
    fprintf(stderr, "%s:%d: broken contract: %s\n", file, line, cond);
    abort();
}

static bool is_known(hn_status status) {
    return (int)status >= 0 && (int)status < HN_STATUS_COUNT;
}

const char *hn_status_name(hn_status status) {
    return is_known(status) ? statuses[status].name : "unknown";
}

const char *hn_status_text(hn_status status) {
    return is_known(status) ? statuses[status].text : "an unknown status";
}
