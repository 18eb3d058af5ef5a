// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/limits.h"

#include <math.h>

/// The first answer may take so many times as long as another, and at least so long [s]: an
/// interpreter has to start.
static const double START_RATIO = 6, LEAST_START = 20;

hn_program_limits hn_program_limits_default(void) {
    // a Java or Octave program needs seconds to start on a busy machine
    return (hn_program_limits){.start = 30,
                               .answer = 5,
                               .cpu = 120,
                               .memory = 768LL << 20,
                               .processes = 64,
                               .files = 16LL << 20,
                               .line = 4LL << 20,
                               .stderr_kept = 4096};
}

void hn_program_limits_set_answer(hn_program_limits *limits, double seconds) {
    limits->answer = seconds;
    limits->start = fmax(LEAST_START, START_RATIO * seconds);
}
