// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_DYNAMICS_ASSEMBLE_POSITION_H
#define HN_DYNAMICS_ASSEMBLE_POSITION_H
// The search for a closed pose: Levenberg-Marquardt far away, least-norm Newton near the end, then
// homotopy and random starts.
// Source: Nocedal & Wright 2006, ch. 10 (Levenberg-Marquardt, gain ratio); Wehage & Haug 1982;
// Allgower & Georg 1990.

#include "dynamics/assembly/assemble_state.h"

#include <stdbool.h>
#include <stdint.h>

/// Searches for a configuration with closed loops, from the guess s->x on. Coordinates that the
/// scene pins keep their values. The best configuration found is left in s->x, s->q, s->residual
/// and s->size. Returns HN_OK when its loops are closed.
/// Fails: HN_ERR_UNREACHABLE; HN_ERR_DIVERGED (phi is not finite at the guess); HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_assemble_position(hn_assembler *s);
/// Descents from s->x, as many as wanted: each returns 1 when it closed the loops.
typedef struct hn_assemble_search hn_assemble_search;
HN_MUST_CHECK hn_status hn_assemble_search_create(hn_assembler *s, hn_assemble_search **out);
bool hn_assemble_descend(hn_assemble_search *w);
double hn_assemble_random(uint64_t *seed); ///< in [-1, 1), the same on every machine

#endif
