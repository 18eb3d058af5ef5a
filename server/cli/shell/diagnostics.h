// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_DIAGNOSTICS_H
#define HN_CLI_DIAGNOSTICS_H
// Faults, as sentences on standard error or as JSON.

#include "base/diag.h"
#include "cli/shell/args.h"

/// Tells the faults: sentences on standard error, or with --json one object on standard output.
/// Returns the exit status that fits.
hn_exit hn_report_diags(const hn_args *args, hn_status status, const hn_diags *diags);
hn_exit hn_report_diag(const hn_args *args, const hn_diag *diag);
#endif
