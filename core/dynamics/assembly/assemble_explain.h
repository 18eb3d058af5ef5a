#ifndef HN_DYNAMICS_ASSEMBLE_EXPLAIN_H
#define HN_DYNAMICS_ASSEMBLE_EXPLAIN_H
// Why a loop stays open, in words.

#include "dynamics/assembly/assemble_state.h"

/// Says why loop `loop` stays open at s->x.
void hn_assemble_explain(hn_assembler *s, int loop);

#endif
