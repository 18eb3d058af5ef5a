// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_STATUS_H
#define HN_BASE_STATUS_H
// The return value of a function that can fail on its data. One list gives the enumerator, its name
// and its sentence.

#include <stdlib.h>

/// value, its name in every document, sentence for a person
#define HN_STATUS_FAILURES(X)                                                                    \
    X(HN_ERR_MEMORY, "out-of-memory", "out of memory")                                           \
    X(HN_ERR_INPUT, "input", "the input is at fault")                                            \
    X(HN_ERR_LIMIT, "limit", "a stated limit is exceeded")                                       \
    X(HN_ERR_IO, "file", "a file could not be read or written")                                  \
    X(HN_ERR_SINGULAR, "singular", "a matrix is singular")                                       \
    X(HN_ERR_NOT_SPD, "not-positive-definite", "a matrix that must be positive definite is not") \
    X(HN_ERR_INCONSISTENT, "inconsistent", "the constraints contradict each other")              \
    X(HN_ERR_NO_CONVERGENCE, "no-convergence", "an iteration did not converge")                  \
    X(HN_ERR_UNREACHABLE, "unreachable", "the loops cannot be closed")                           \
    X(HN_ERR_CHART, "chart-lost", "the chosen coordinates stopped being valid here")             \
    X(HN_ERR_DIVERGED, "diverged", "the state grew beyond all bounds or stopped being finite")   \
    X(HN_ERR_STEP_UNDERFLOW, "step-underflow", "the step became too small to make progress")     \
    X(HN_ERR_STOPPED, "stopped",                                                                 \
      "the limit of steps or time was reached, or it was asked to stop")                         \
    X(HN_ERR_UNSUPPORTED, "unsupported", "this combination is not supported")                    \
    X(HN_ERR_INTERNAL, "internal", "the program is at fault")                                    \
    X(HN_ERR_MASS, "mass-singular", "the mass matrix has no inverse")
#define HN_STATUS_LIST(X) X(HN_OK, "ok", "done") HN_STATUS_FAILURES(X)

typedef enum hn_status {
#define HN_STATUS_ENUM(value, name, text) value,
    HN_STATUS_LIST(HN_STATUS_ENUM)
#undef HN_STATUS_ENUM
        HN_STATUS_COUNT
} hn_status;

/// Returns the status of `call` from the calling function unless it is HN_OK.
/// Legal wherever memory belongs to an arena, so that an early return leaks nothing.
#define HN_TRY(call)                            \
    do {                                        \
        const hn_status hn_try_status = (call); \
        if (hn_try_status != HN_OK)             \
            return hn_try_status;               \
    } while (0)

/// Makes the call and assigns its result to `status`, unless `status` is a failure already. For
/// sequences after which memory has to be released or a fault reported; elsewhere use HN_TRY.
#define HN_THEN(status, ...)          \
    do {                              \
        if ((status) == HN_OK)        \
            (status) = (__VA_ARGS__); \
    } while (0)

#define HN_MUST_CHECK __attribute__((warn_unused_result))
#define HN_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))

/// Aborts on a programmer's error (NULL, wrong size, wrong order of calls), in every build.
#define HN_ASSERT(cond) ((cond) ? (void)0 : hn_assert_failed(#cond, __FILE__, __LINE__))

/// Prints the condition and its place to standard error and aborts. Called by HN_ASSERT() alone.
_Noreturn void hn_assert_failed(const char *cond, const char *file, int line);

/// "input" and "the input is at fault"; static text, never NULL.
const char *hn_status_name(hn_status status);
const char *hn_status_text(hn_status status);

#endif
