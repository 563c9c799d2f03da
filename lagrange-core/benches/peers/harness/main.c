/* Times implementations of one system in one process, taking samples in rotation: A, B, C, A, B, C, ...
 *
 *   harness SYSTEM N SAMPLES MILLISECONDS independent|chained LIBRARY:FUNCTION...
 *
 * A sample is as many evaluations as take MILLISECONDS, over 64 states in turn. Independent ones may overlap in the
 * processor; of chained ones each input depends on the result before, as in an integration. Before that, every
 * implementation is checked at all states. Prints a line of JSON for each: the largest error and the nanoseconds
 * per evaluation in each sample. */
#define _GNU_SOURCE
#include "systems.h"
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { IMPLEMENTATIONS = 64, SAMPLES = 256 };

typedef struct {
    Evaluation evaluate;
    double error;
    long count;
    double nanoseconds[SAMPLES];
} Implementation;

static Inputs inputs;
static double a[RESULTS], lambda[ENTRIES];
static volatile double sink;

double uniform(double low, double high) {
    static unsigned long long seed = 88172645463325252ULL;
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return low + (high - low) * ((seed >> 11) / 9007199254740992.0);
}

const System *find_system(const char *name) {
    static const System *const SYSTEMS[] = {
        &PLANAR,           &LANES,        &CHAIN,          &SPHERICAL,
        &BODIES,           &ARM,          &DENAVIT,        &QUADRUPED,
        &QUADRUPED_ANGLES, &HUMANOID,     &FOUR_BAR,       &STEWART,
        &ARM_JACOBIAN,     &ARM_INVERSE,  &ARM_MASS,       &ARM_DERIVATIVES,
        &QUADRUPED_INVERSE, &QUADRUPED_MASS, &QUADRUPED_DERIVATIVES,
        &HUMANOID_INVERSE, &HUMANOID_MASS, &HUMANOID_DERIVATIVES,
    };
    for (size_t k = 0; k < sizeof SYSTEMS / sizeof *SYSTEMS; k++)
        if (!strcmp(SYSTEMS[k]->name, name)) return SYSTEMS[k];
    return NULL;
}

/* The time that this process had, so that others on the machine disturb less. */
static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * t.tv_sec + t.tv_nsec;
}

/* The nanoseconds that `count` evaluations take. */
static double independent(Evaluation evaluate, long count) {
    double start = now();
    for (long i = 0; i < count; i++) evaluate(q_of(&inputs, i), v_of(&inputs, i), inputs.p, a, lambda);
    sink = a[0];
    return now() - start;
}

static double chained(Evaluation evaluate, long count) {
    double start = now();
    for (long i = 0; i < count; i++) {
        double *q = q_of(&inputs, i);
        for (int k = 0; k < inputs.coordinates; k++) q[k] += 1e-300 * a[k];
        evaluate(q, v_of(&inputs, i), inputs.p, a, lambda);
    }
    sink = a[0];
    return now() - start;
}

static Evaluation load(char *path) {
    char *function = strrchr(path, ':');
    *function++ = 0;
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    void *symbol = library ? dlsym(library, function) : NULL;
    if (!symbol) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    return (Evaluation)symbol;
}

static double largest_error(const System *system, Evaluation evaluate) {
    double largest = 0;
    for (int s = 0; s < STATES; s++) {
        memset(a, 0xff, sizeof a);
        memset(lambda, 0xff, sizeof lambda);
        evaluate(q_of(&inputs, s), v_of(&inputs, s), inputs.p, a, lambda);
        double error = system->error(&inputs, s, a, lambda);
        if (!(error <= largest)) largest = error;
    }
    return largest;
}

int main(int count, char **arguments) {
    if (count < 7 || count - 6 > IMPLEMENTATIONS || atoi(arguments[3]) > SAMPLES) return 2;
    const System *system = find_system(arguments[1]);
    if (!system) return 2;
    inputs.n = atoi(arguments[2]);
    int samples = atoi(arguments[3]), implementations = count - 6;
    double least = 1e6 * atof(arguments[4]);
    double (*time)(Evaluation, long) = strcmp(arguments[5], "chained") ? independent : chained;
    static Implementation list[IMPLEMENTATIONS];

    system->prepare(&inputs);
    for (int k = 0; k < implementations; k++) {
        list[k].evaluate = load(arguments[6 + k]);
        list[k].error = largest_error(system, list[k].evaluate);
        memset(a, 0, sizeof a);
        for (list[k].count = STATES; time(list[k].evaluate, list[k].count) < least;) list[k].count *= 2;
    }
    for (int sample = 0; sample < samples; sample++)
        for (int k = 0; k < implementations; k++)
            list[k].nanoseconds[sample] = time(list[k].evaluate, list[k].count) / list[k].count;
    for (int k = 0; k < implementations; k++) {
        printf("{\"error\": %.3e, \"times\": [", isfinite(list[k].error) ? list[k].error : 1e300);
        for (int sample = 0; sample < samples; sample++) printf("%s%.3f", sample ? ", " : "", list[k].nanoseconds[sample]);
        printf("]}\n");
    }
    return 0;
}
