// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/remedies.h"

#include "formulations/list/formulation_list.h"
#include "integrators/method/guest.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Share of the largest sigma_min so far.
static const double CLOSE = 0.1;
/// [s]: goes through the singular configurations of the ladder of four-bars for every step up to
/// twice this.
static const double LONGEST = 0.01;

/// The finest tolerance that is offered, some hundred roundings; over one that is finer.
static const double FINEST = 5e-14, COARSER = 100;

enum {
    CLOSED = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY,
    WRONG = HN_TRAIT_COUNTER_EXAMPLE
};

/// Says whether the present state is close to a singular configuration.
static bool is_near_singular(const hn_watch *w) {
    const bool starts = w->singular.at_start && w->run->steps == 0;
    return starts ||
           (w->run->info.nc > 0 && w->singular.info.sigma_min < CLOSE * w->singular.largest);
}

static const hn_formulation *formulation_of(const hn_watch *w) {
    return w->run->spec.formulation;
}

/// Loops closed after every step, in any coordinates.
static const hn_formulation *closing(void) {
    return hn_formulation_with(CLOSED, HN_TRAIT_HAS_CHART | WRONG);
}

static double tolerance(const hn_watch *w) {
    return hn_method_option(&w->run->spec, "rtol", 1e-6);
}

/// Returns whether an integrator serves a formulation that is in the list; a program's own steps
/// serve it alone.
static bool fits(const hn_formulation *f, const hn_stepper *stepper) {
    return strcmp(stepper->name, HN_GUEST_STEPPER) != 0 && hn_method_fits(f, stepper);
}

/// Another formulation with its defaults, the integrator as it is where it serves that too.
static bool write_formulation(const hn_watch *w, const hn_formulation *f, hn_remedy out) {
    hn_method_spec spec = w->run->spec;
    char text[HN_SPEC_MAX];
    spec.formulation = f;
    if (!fits(f, spec.stepper)) {
        snprintf(out, sizeof(hn_remedy), "%s@%s:rtol=1e-8", f->name,
                 f->form == HN_FORM_ODE ? "dopri5" : "radau5");
        return true;
    }
    for (int i = 0; i < f->n_options; i++) {
        spec.formulation_set[i] = f->options[i].initial;
    }
    hn_method_format(&spec, text);
    snprintf(out, sizeof(hn_remedy), "%s%s", f->name, strchr(text, '@'));
    return true;
}

bool hn_remedy_finer(const hn_watch *w, double factor, hn_remedy out) {
    const char *key = w->run->adaptive ? "rtol" : "h";
    const double now = hn_method_option(&w->run->spec, key, 0);
    // a tolerance near rounding fails because it is so fine: a coarser one is what may help
    const bool too_fine = w->run->adaptive && now * factor < FINEST;
    snprintf(out, sizeof(hn_remedy), "%s=%.4g", key, too_fine ? COARSER * now : now * factor);
    // where no chart is regular a shorter step does not help
    return w->failure != HN_ERR_UNSUPPORTED;
}

// ---- other formulations ----

bool hn_remedy_close(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    return closing() != formulation_of(w) && write_formulation(w, closing(), out);
}

bool hn_remedy_robust(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    const hn_stepping *s = w->run;
    const double mean = s->steps > 0 ? (s->now.t - s->t0) / (double)s->steps : LONGEST;
    const double fixed = hn_method_option(&s->spec, "h", 0);
    const double h = fixed > 0 ? fixed : fmin(fmax(mean, 1e-4), LONGEST);
    const bool serves = fits(closing(), s->spec.stepper);
    const bool same = closing() == formulation_of(w) && fixed > 0;
    snprintf(out, sizeof(hn_remedy), "%s@%s:h=%.4g", closing()->name,
             fixed > 0 && serves && !same ? s->spec.stepper->name : "rk4",
             same ? 0.7 * h : h); // another step lands beside the singular configuration
    return true;
}

bool hn_remedy_robust_near(const hn_watch *w, double factor, hn_remedy out) {
    return is_near_singular(w) && hn_remedy_robust(w, factor, out);
}

bool hn_remedy_feedback(const hn_watch *w, double factor, hn_remedy out) {
    const unsigned cares = CLOSED | HN_TRAIT_PULLS_GAP;
    const hn_method_spec *spec = &w->run->spec;
    const double h = hn_method_option(spec, "h", 0);
    const hn_formulation *f = hn_formulation_with(HN_TRAIT_PULLS_GAP, HN_TRAIT_ADDS_VIBRATIONS);
    if (formulation_of(w)->traits & cares || !write_formulation(w, f, out)) {
        return false;
    }
    if (h > 0 && fits(f, spec->stepper)) {
        const double rate = fmin(factor / h, f->options[0].max);
        snprintf(out, sizeof(hn_remedy), "%s:alpha=%.3g,beta=%.3g@%s:h=%.4g", f->name, rate, rate,
                 spec->stepper->name, h);
    }
    return true;
}

bool hn_remedy_right_model(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    const hn_formulation *f = hn_formulation_with(CLOSED | HN_TRAIT_HAS_BASIS, WRONG);
    return formulation_of(w)->model_error && write_formulation(w, f, out);
}

bool hn_remedy_other_chart(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    const hn_formulation *f =
        hn_formulation_with(HN_TRAIT_HAS_CHART, HN_TRAIT_FIXED_CHART | HN_TRAIT_HAS_BASIS | WRONG);
    if (w->failure == HN_ERR_UNSUPPORTED || f == formulation_of(w)) {
        f = closing();
    }
    return write_formulation(w, f, out);
}

bool hn_remedy_plain(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    return closing() == formulation_of(w) &&
           write_formulation(w, hn_formulation_with(0, CLOSED | HN_TRAIT_PULLS_GAP | WRONG), out);
}

bool hn_remedy_singular_mass(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    const hn_formulation *f = formulation_of(w);
    if (f->traits & HN_TRAIT_NEEDS_MASS_INVERSE) {
        // the form next to this one: velocities closed by a differential-algebraic integrator, or
        // the closing formulation
        return write_formulation(
            w,
            f->form == HN_FORM_ODE
                ? closing()
                : hn_formulation_with(HN_TRAIT_CLOSES_VELOCITY, HN_TRAIT_CLOSES_POSITION),
            out);
    }
    return hn_method_option(&w->run->spec, "solver", HN_SOLVER_AUTO) != HN_SOLVER_AUTO &&
           write_formulation(w, f, out);
}

// ---- feedback against the step ----

// Returns the larger root of s^2 + 2 damping s + rate^2, or its size alone when the pair is
// complex.
double hn_pulling_rate(const hn_method_spec *spec) {
    const unsigned traits = spec->formulation->traits;
    double damping = hn_method_option(spec, "alpha", 0);
    double rate = hn_method_option(spec, "beta", 0);
    if (traits & HN_TRAIT_ADDS_VIBRATIONS) {
        rate = hn_method_option(spec, "omega", 0);
        damping = rate * hn_method_option(spec, "xi", 0);
    } else if (!(traits & HN_TRAIT_PULLS_GAP) || hn_method_option(spec, "rule", 0) != 0) {
        return 0;
    }
    const double square = damping * damping - rate * rate;
    return square > 0 ? damping + sqrt(square) : fabs(rate);
}

bool hn_remedy_slower_feedback(const hn_watch *w, double factor, hn_remedy out) {
    const hn_method_spec *spec = &w->run->spec;
    const double h = hn_method_option(spec, "h", 0), safe = factor / h;
    if (formulation_of(w)->traits & HN_TRAIT_ADDS_VIBRATIONS) {
        snprintf(out, sizeof(hn_remedy), "%s:omega=%.4g@%s:h=%.4g", formulation_of(w)->name, safe,
                 spec->stepper->name, h);
    } else {
        snprintf(out, sizeof(hn_remedy), "%s:alpha=%.4g,beta=%.4g@%s:h=%.4g",
                 formulation_of(w)->name, safe, safe, spec->stepper->name, h);
    }
    return true;
}

bool hn_remedy_step_for_feedback(const hn_watch *w, double factor, hn_remedy out) {
    const hn_method_spec *spec = &w->run->spec;
    snprintf(out, sizeof(hn_remedy), "h=%.3g",
             factor * spec->stepper->real_limit / hn_pulling_rate(spec));
    return true;
}

bool hn_remedy_step_of_run(const hn_watch *w, double factor, hn_remedy out) {
    snprintf(out, sizeof(hn_remedy), "h=%.3g", factor * (w->t_end - w->run->t0));
    return true;
}

// ---- other integrators ----

bool hn_remedy_stiff_closed(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    // the first that both closes the loops and hands over the differential-algebraic system
    for (int i = 0; i < hn_formulation_count(); i++) {
        const hn_formulation *f = hn_formulation_at(i);
        if ((f->traits & CLOSED) == CLOSED && f->form != HN_FORM_ODE) {
            snprintf(out, sizeof(hn_remedy), "%s@radau5:rtol=%.3g", f->name, tolerance(w));
            return true;
        }
    }
    return false;
}

bool hn_remedy_stiff_same(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    snprintf(out, sizeof(hn_remedy), "%s@radau5:rtol=%.3g", formulation_of(w)->name, tolerance(w));
    return formulation_of(w)->form == HN_FORM_ODE;
}

bool hn_remedy_stiff_multistep(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    const hn_formulation *plain = hn_formulation_with(0, CLOSED | HN_TRAIT_PULLS_GAP | WRONG);
    snprintf(out, sizeof(hn_remedy), "%s@ida:rtol=%.3g", plain->name, tolerance(w));
    return true;
}

bool hn_remedy_one_step(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    snprintf(out, sizeof(hn_remedy), "%s@dop853:rtol=%.3g", formulation_of(w)->name, tolerance(w));
    return true;
}

bool hn_remedy_uncorrected(const hn_watch *w, double factor, hn_remedy out) {
    (void)factor;
    const hn_formulation *f = hn_formulation_with(HN_TRAIT_PULLS_GAP, HN_TRAIT_ADDS_VIBRATIONS);
    snprintf(out, sizeof(hn_remedy), "%s@%s:rtol=%.3g", f->name, w->run->spec.stepper->name,
             tolerance(w));
    return w->run->info.nq == w->run->info.nv; // no quaternion that is brought back to length 1
}
