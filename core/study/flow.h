#ifndef HN_STUDY_FLOW_H
#define HN_STUDY_FLOW_H
// The flow of an ordinary differential equation over a short time, to all digits that double precision gives: what a step
// of an integrator is measured against.

#include "base/arena.h"
#include "methods/method.h"

typedef struct hn_flow hn_flow;
/// For equations of n_pos + n_vel unknowns; memory from `arena`. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_flow_create(int n_pos, int n_vel, hn_arena *arena, hn_flow **out);
/// y at t + h from y at t (h > 0), by Dormand-Prince 8 with steps that keep the local error below `tol` of each entry, and of 1, or as small as rounding of the right-hand side allows. y and y_end
/// may be the same. Fails with the right-hand side's status, HN_ERR_STEP_UNDERFLOW, HN_ERR_DIVERGED.
HN_MUST_CHECK hn_status hn_flow_run(hn_flow *flow, const hn_ode *ode, double tol, double t,
                                    double h, const double *y, double *y_end);
#endif
