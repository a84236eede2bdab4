/* The shortest order in which to visit a few points: tour.py says for what.

   Dynamic programming over sets of points: Held and Karp, "A dynamic programming approach to
   sequencing problems" (1962). It is bounded: a good path is found first, and what can no longer
   become shorter than that is not followed. */
#include "formulas.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Two lengths that differ by less than this part of them may be equal. */
#define ROUNDING 1e-12

typedef uint32_t Set; /* bit j is point j */

/* The problem: lengths between n points, from the start to each, and from each to the end. */
typedef struct {
    int n;
    double between[MOST_EXACT][MOST_EXACT];
    double from_start[MOST_EXACT], to_end[MOST_EXACT];
} Tour;

static Tour read_tour(int n, const double *distances, bool return_home)
{
    Tour tour = {.n = n};
    for (int i = 0; i < n; i++) {
        const double *row = distances + (i + 1) * (n + 1);
        tour.from_start[i] = row[0];
        tour.to_end[i] = return_home ? row[0] : 0;
        for (int j = 0; j < n; j++)
            tour.between[i][j] = row[j + 1];
    }
    return tour;
}

static double length_of(const Tour *tour, const int *order)
{
    double length = tour->from_start[order[0]] + tour->to_end[order[tour->n - 1]];
    for (int i = 1; i < tour->n; i++)
        length += tour->between[order[i - 1]][order[i]];
    return length;
}

static void swap(int *a, int *b)
{
    int kept = *a;
    *a = *b;
    *b = kept;
}

/* From a first point always to the nearest one that is left. */
static void visit_nearest(const Tour *tour, int first, int *order)
{
    for (int i = 0; i < tour->n; i++)
        order[i] = i;
    swap(&order[0], &order[first]);
    for (int i = 1; i < tour->n; i++) {
        const double *to = tour->between[order[i - 1]];
        int nearest = i;
        for (int j = i + 1; j < tour->n; j++)
            if (to[order[j]] < to[order[nearest]])
                nearest = j;
        swap(&order[i], &order[nearest]);
    }
}

/* Turns stretches of the order round for as long as one of them makes the path shorter (2-opt). */
static void untangle(const Tour *tour, int *order)
{
    const double(*d)[MOST_EXACT] = tour->between;
    int n = tour->n;
    for (bool shorter = true; shorter;) {
        shorter = false;
        for (int i = 0; i < n; i++)
            for (int j = i + 1; j < n; j++) {
                const double *to = i ? d[order[i - 1]] : tour->from_start;
                int a = order[i], b = order[j];
                double before = to[a] + (j + 1 < n ? d[b][order[j + 1]] : tour->to_end[b]);
                double after = to[b] + (j + 1 < n ? d[a][order[j + 1]] : tour->to_end[a]);
                if (after >= before * (1 - ROUNDING))
                    continue;
                for (int k = i, l = j; k < l; k++, l--)
                    swap(&order[k], &order[l]);
                shorter = true;
            }
    }
}

/* The length of a path that is good, and often the shortest: the best of those from each point. */
static double good_length(const Tour *tour)
{
    double best = INFINITY;
    for (int first = 0; first < tour->n; first++) {
        int order[MOST_EXACT];
        visit_nearest(tour, first, order);
        untangle(tour, order);
        best = fmin(best, length_of(tour, order));
    }
    return best;
}

/* A bound of the way through a set of points, from one of them to the end: it has no fewer lines
   than their shortest spanning tree, and no shorter ones (Prim 1957). */
static double least_way(const Tour *tour, Set set)
{
    int outside[MOST_EXACT], n = 0;
    double to_tree[MOST_EXACT], to_end = INFINITY, length = 0;
    for (int j = 0; j < tour->n; j++)
        if (set >> j & 1) {
            to_end = fmin(to_end, tour->to_end[j]);
            to_tree[n] = INFINITY;
            outside[n++] = j;
        }
    while (n > 1) {
        const double *to = tour->between[outside[--n]]; /* the one last found is in the tree now */
        int nearest = 0;
        for (int k = 0; k < n; k++) {
            to_tree[k] = fmin(to_tree[k], to[outside[k]]);
            if (to_tree[k] < to_tree[nearest])
                nearest = k;
        }
        length += to_tree[nearest];
        int next = outside[nearest];
        outside[nearest] = outside[n - 1], to_tree[nearest] = to_tree[n - 1];
        outside[n - 1] = next;
    }
    return length + to_end;
}

/* What paths from the start leave of a length that must not be passed. left[S * n + j]: the most
   that one through the set S leaves that ends at its point j; ends[S]: the points j of S at which
   a path ends that leaves as much as the way on will take. Both begin as zeros, in memory that
   takes room only where something else is written: of few sets, mostly. */
typedef struct {
    double *left;
    Set *ends;
} Paths;

static void extend(const Tour *tour, Set set, Paths paths)
{
    int n = tour->n;
    double most[MOST_EXACT] = {0};
    const double *left = paths.left + (size_t)set * n;
    for (int i = 0; i < n; i++)
        if (paths.ends[set] >> i & 1)
            for (int j = 0; j < n; j++) {
                double beyond = left[i] - tour->between[i][j];
                most[j] = beyond > most[j] ? beyond : most[j];
            }
    double way_on = least_way(tour, ~set);
    for (int j = 0; j < n; j++)
        if (!(set >> j & 1) && most[j] > way_on) {
            Set longer = set | (Set)1 << j;
            paths.left[(size_t)longer * n + j] = most[j];
            paths.ends[longer] |= (Set)1 << j;
        }
}

/* From the set of all points: the end that leaves most, then what it was reached from. */
static void walk_back(const Tour *tour, Paths paths, int *order)
{
    int n = tour->n;
    Set set = ((Set)1 << n) - 1;
    const double *on = tour->to_end;
    for (int place = n - 1; place >= 0; place--) {
        const double *left = paths.left + (size_t)set * n;
        int end = -1;
        for (int j = 0; j < n; j++)
            if (paths.ends[set] >> j & 1 && (end < 0 || left[j] - on[j] > left[end] - on[end]))
                end = j;
        order[place] = end;
        on = tour->between[end];
        set ^= (Set)1 << end;
    }
}

bool held_karp(int n, const double *distances, bool return_home, int *order)
{
    if (n < 1)
        return true;
    Tour tour = read_tour(n, distances, return_home);
    size_t n_sets = (size_t)1 << n;
    Paths paths = {calloc(n_sets * n, sizeof(double)), calloc(n_sets, sizeof(Set))};
    bool has_memory = paths.left && paths.ends;
    if (has_memory) {
        double bound = good_length(&tour) * (1 + ROUNDING) + DBL_MIN;
        for (int j = 0; j < n; j++) {
            Set set = (Set)1 << j;
            paths.left[(size_t)set * n + j] = bound - tour.from_start[j];
            paths.ends[set] = set;
        }
        for (Set set = 1; set < n_sets - 1; set++)
            if (paths.ends[set])
                extend(&tour, set, paths);
        walk_back(&tour, paths, order);
    }
    free(paths.left);
    free(paths.ends);
    return has_memory;
}
