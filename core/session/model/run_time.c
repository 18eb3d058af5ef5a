// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/run_time.h"

#include "base/units.h"

hn_status hn_run_time_check(double time, bool zero, const char *name, const char *pointer,
                            hn_diags *diags) {
    if ((time > 0 || (zero && time == 0)) && time <= HN_RUN_TIME_MAX) {
        return HN_OK;
    }
    return hn_diags_add(diags, HN_ERR_INPUT, pointer, NULL, "the %s is %.*g s; %s", name,
                        hn_digits_apart(time, HN_RUN_TIME_MAX, 6), time,
                        zero ? "0 to 1e6 s are allowed" : "it must be above 0 and at most 1e6 s");
}
