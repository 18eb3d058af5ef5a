// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/failure.h"

#include "session/store/ending_json.h"

void hn_failure_put_json(hn_strbuf *b, const hn_run *run, hn_status ended, const char *reason,
                         double t) {
    const hn_ending e = hn_ending_of(run, ended, reason, t);
    hn_ending_put_json(b, &e, reason, t);
}
