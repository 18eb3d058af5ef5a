// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_PROGRAM_GUEST_PROCESS_H
#define HN_PROGRAM_GUEST_PROCESS_H
// A process that answers lines with lines, watched while it does: wall clock, memory and number of
// its processes. It may do anything: die, hang, flood, write what is no text.

#include "base/diag.h"
#include "base/strbuf.h"
#include "program/limits.h"

#include <stdbool.h>
#include <sys/types.h>
#include <time.h>

enum { HN_GUEST_ERRORS = 4096, HN_GUEST_FILE = 3, HN_GUEST_CLOCKS = 64 };

typedef struct hn_guest_process {
    pid_t pid; ///< 0: there is none
    int in, out, err;
    hn_program_limits limits;
    hn_strbuf pending;            ///< read, but not yet asked for
    char errors[HN_GUEST_ERRORS]; ///< the beginning of its standard error
    int n_errors;
    char file[64];  ///< name of the program's file
    bool confined;  ///< it is in the sandbox, with this file alone
    long long peak; ///< [bytes] of memory, the most that was seen
    double cpu;     ///< [s]; known after hn_guest_process_end()
    // the CPU clocks of its processes, as they were found
    clockid_t clocks[HN_GUEST_CLOCKS];
    int n_clocks;
    double found; ///< when that was [s]
} hn_guest_process;

/// Starts a command line; it finds `file` (NULL: none) open for reading as HN_GUEST_FILE. Fails:
/// HN_ERR_IO.
HN_MUST_CHECK hn_status hn_guest_process_start(hn_guest_process *p, char *const *argv,
                                               const char *file, const hn_program_limits *limits,
                                               hn_diag *diag);
/// Sends the text and waits for one line, without its end, in `line`. Fails, with what the process
/// did in diag: HN_ERR_LIMIT (a limit), HN_ERR_IO (it ended).
HN_MUST_CHECK hn_status hn_guest_process_ask(hn_guest_process *p, const char *text, size_t n,
                                             double seconds, hn_strbuf *line, hn_diag *diag);
/// Returns whether it has written more than it was asked for.
bool hn_guest_process_has_more(hn_guest_process *p);
/// Starts a stop-watch: returns the computing time of its processes so far [s]. Processes that it
/// has started since it was last looked at are found first, at most twenty times a second.
double hn_guest_process_clock_start(hn_guest_process *p);
/// Returns how much computing time has passed since `begin` [s], of the processes known then.
double hn_guest_process_clock_stop(const hn_guest_process *p, double begin);
/// Waits for its end: its exit status, 128 + signal, or -1 when the time is over.
int hn_guest_process_wait(hn_guest_process *p, double seconds);
/// The beginning of its standard error, printable.
const char *hn_guest_process_errors(hn_guest_process *p);
/// Closes its input, gives it a moment, kills it and everything that it started. Harmless twice.
void hn_guest_process_end(hn_guest_process *p);

#endif
