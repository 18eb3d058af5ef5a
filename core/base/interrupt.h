// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_INTERRUPT_H
#define HN_BASE_INTERRUPT_H
// Stops long work early: the work calls a function of the caller now and then, and stops when it
// returns true. The caller owns what the function reads (a flag, a clock).

#include <stdbool.h>
#include <stddef.h>

/// The question. `must_end` NULL: the work goes on to its end. It is called on the thread that
/// works, some thousand times a second.
typedef struct hn_interrupt {
    bool (*must_end)(void *user);
    void *user;
} hn_interrupt;

/// Asks. `interrupt` may be NULL.
static inline bool hn_interrupt_ask(const hn_interrupt *interrupt) {
    return interrupt && interrupt->must_end && interrupt->must_end(interrupt->user);
}

#endif
