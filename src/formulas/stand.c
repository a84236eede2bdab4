/* Where the arm can stand with its tool at a place: for the search and the smoothing in resolve/. */
#include "formulas.h"

#include <math.h>

/* By how much an angle is nearer to its limits than a margin, or beyond them. */
static inline double excess_of(double angle, double lower, double upper, double margin)
{
    double excess = fmax(lower - angle, angle - upper) + margin;
    return excess <= LIMIT_ROUNDING ? 0 : excess;
}

/* Joint 1 on a track, not turned into its limits: it does not depend on the pitch. */
static inline double joint_1(const Place *place, int track)
{
    return arm.offset[0] - (place->azimuth + PI * track);
}

void stand(const Place *place, int track, double pitch, const Limits *limits,
           double joints[2][STAND_JOINTS], double excess[2][STAND_JOINTS])
{
    const double *lower = limits->lower, *upper = limits->upper;
    double bent[2][3], ignored;
    Point tool = {track ? -place->point.r : place->point.r, place->point.z};
    double beyond = bend(tool, pitch, bent);
    for (int elbow = 0; elbow < 2; elbow++)
        for (int j = 0; j < STAND_JOINTS; j++) {
            double raw = j ? bent[elbow][j - 1] : joint_1(place, track);
            double angle = turned(raw, lower[j], upper[j], &ignored);
            joints[elbow][j] = angle;
            excess[elbow][j] = beyond != 0 ? NAN : excess_of(angle, lower[j], upper[j], place->margin);
        }
}

static inline bool is_zero(const double excess[STAND_JOINTS])
{
    return excess[0] == 0 && excess[1] == 0 && excess[2] == 0 && excess[3] == 0;
}

/* The cell of a pitch on both branches of a track: see standings. */
static void fill_cell(const Place *place, int track, const double *pitches, int finer,
                      const Limits *limits, const Joints velocity, float *cells[2], float *at[2])
{
    bool found[2] = {false, false};
    for (int i = 0; i < finer && !(found[0] && found[1]); i++) {
        double pitch = pitches[finer / 2 + (i % 2 ? -(i + 1) / 2 : i / 2)]; /* from the middle out */
        double joints[2][STAND_JOINTS], excess[2][STAND_JOINTS];
        stand(place, track, pitch, limits, joints, excess);
        for (int elbow = 0; elbow < 2; elbow++) {
            if (found[elbow] || !is_zero(excess[elbow]))
                continue;
            found[elbow] = true;
            *at[elbow] = (float)pitch;
            for (int j = 0; j < STAND_JOINTS; j++)
                cells[elbow][j] = (float)joints[elbow][j] / (float)velocity[j];
        }
    }
}

/* Whether joint 1 is inside its limits on a track, and pitches are worth trying. */
static bool is_open(const Place *place, int track, const Limits *limits)
{
    double lower = limits->lower[0], upper = limits->upper[0], ignored;
    double angle = turned(joint_1(place, track), lower, upper, &ignored);
    return excess_of(angle, lower, upper, place->margin) == 0;
}

void standings(const Place *place, const double *pitches, int n_cells, int finer,
               const Limits *limits, const Joints velocity, Cell *cells, float *pitch)
{
    for (int i = 0; i < BRANCHES * n_cells; i++) {
        pitch[i] = (float)pitches[i % n_cells * finer + finer / 2];
        for (int j = 0; j < STAND_JOINTS; j++)
            cells[i][j] = NAN;
    }
    for (int track = 0; track < 2; track++) {
        if (!is_open(place, track, limits))
            continue;
        for (int i = 0; i < n_cells; i++) {
            int plus = 2 * track * n_cells + i, minus = plus + n_cells;
            float *both[2] = {cells[plus], cells[minus]}, *at[2] = {pitch + plus, pitch + minus};
            fill_cell(place, track, pitches + i * finer, finer, limits, velocity, both, at);
        }
    }
}
