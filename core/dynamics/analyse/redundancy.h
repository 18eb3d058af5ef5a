#ifndef HN_DYNAMICS_REDUNDANCY_H
#define HN_DYNAMICS_REDUNDANCY_H
// Closure rows that say nothing new, by name: those that vanish whatever the pose (the compiler
// dropped them), and those that follow from rows before them at one pose.

#include "base/strbuf.h"
#include "dynamics/compile/system.h"

/// Writes "redundant_rows" {"vanish": [names], "follow": [{"row", "from": [names]}]} into the JSON
/// object that is open in `b`. Rows are taken in their order; one follows when what is left of it,
/// beside the rows kept before, is below 1e-9 of it [-], lengths measured by diag(M)^-1/2, which
/// the units of coordinates do not move. "from" names the rows it is a combination of; it is empty
/// for a row that is zero at this pose. q (nq), t: the pose. Compiles a tape (system.h says who may
/// do that when).
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT; the object is then incomplete.
HN_MUST_CHECK hn_status hn_system_redundancy_put(hn_strbuf *b, const hn_system *sys, double t,
                                                 const double *q);
#endif
