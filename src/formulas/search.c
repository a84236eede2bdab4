/* The steps of the search for the best joint path along a tour: resolve/search.py says what it is,
   and what its costs are. */
#include "formulas.h"

#include <math.h>

/* Time of a smooth step between two cells: INFINITY if a joint would move for longer than the tear,
   or the arm cannot stand in one of them. */
static inline double step_time(const Cell before, const Cell after, float tear)
{
    float longest = 0;
    for (int j = 0; j < STAND_JOINTS; j++) {
        float time = fabsf(after[j] - before[j]);
        if (!(time <= tear)) /* NaN is no way either */
            return INFINITY;
        if (time > longest)
            longest = time;
    }
    return longest;
}

void smooth_step(const Cell *before, const Cell *after, const double *cost, int n_pitches,
                 int reach, float tear, double *total, int16_t *origin)
{
    for (int cell = 0; cell < BRANCHES * n_pitches; cell++) {
        int pitch = cell % n_pitches, branch = cell - pitch;
        total[cell] = INFINITY;
        origin[cell] = (int16_t)cell;
        if (isnan(after[cell][0]))
            continue;
        for (int i = -reach; i <= reach; i++) {
            int other = branch + (pitch + i + n_pitches) % n_pitches;
            if (!(cost[other] < total[cell]))
                continue;
            double sum = cost[other] + step_time(before[other], after[cell], tear);
            if (sum < total[cell]) {
                total[cell] = sum;
                origin[cell] = (int16_t)other;
            }
        }
    }
}

/* Time (s) from rest to rest over a distance over velocity (s), where acceleration over velocity is
   the rate (1/s). The trapezoidal profile: Siciliano et al. (2009), section 4.2.1. */
static inline double move_time(double distance, double rate)
{
    return distance * rate < 1 ? 2 * sqrt(distance / rate) : distance + 1 / rate;
}

/* The largest of the joints' distances over their velocities, s. */
static inline double distance(const Cell before, const Cell after)
{
    double longest = 0;
    for (int j = 0; j < STAND_JOINTS; j++)
        longest = fmax(longest, fabs((double)after[j] - before[j]));
    return longest;
}

void move(const Cell *before, const Cell *after, const double *cost, const bool *sources,
          const bool *targets, int n_cells, double rate, double extra, double *total,
          int16_t *origin)
{
    for (int cell = 0; cell < n_cells; cell++) {
        total[cell] = INFINITY;
        origin[cell] = (int16_t)cell;
        if (!targets[cell])
            continue;
        for (int other = 0; other < n_cells; other++) {
            if (!sources[other] || !(cost[other] + extra < total[cell]))
                continue;
            double time = move_time(distance(before[other], after[cell]), rate);
            if (cost[other] + time + extra < total[cell]) {
                total[cell] = cost[other] + time + extra;
                origin[cell] = (int16_t)other;
            }
        }
    }
}
