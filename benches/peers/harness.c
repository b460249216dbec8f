/* `check` prints what each way makes of the first poses, `time` the least time of
   a pass over all poses, in ns a pose. As harness.rs does. */
#include "harness.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { JOINTS = 6, ENTRIES = 16 + 6 * JOINTS + 21, CHECKED = 64 };

static double poses[COUNT * JOINTS], results[COUNT * ENTRIES];
static double angles[JOINTS][COUNT], entries[ENTRIES][COUNT];
static float angles_f32[JOINTS][COUNT], entries_f32[ENTRIES][COUNT];

static void pass(const struct way *way) {
    if (way->all) {
        way->all((const double (*)[COUNT])angles, entries);
    } else if (way->all_f32) {
        way->all_f32((const float (*)[COUNT])angles_f32, entries_f32);
    } else {
        for (int k = 0; k < COUNT; k++) way->one(&poses[k * way->joints], &results[k * way->size]);
    }
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * 1e9 + time.tv_nsec;
}

static double least(const struct way *way) {
    double least = INFINITY;
    for (double first = now(), start = first; start < first + 15e6;) {
        pass(way);
        const double end = now();
        least = fmin(least, end - start);
        start = end;
    }
    return least / COUNT;
}

static double entry(const struct way *way, int k, int e) {
    if (way->all) return entries[e][k];
    return way->all_f32 ? entries_f32[e][k] : results[k * way->size + e];
}

int main(int count, char **arguments) {
    const int check = count > 1 && strcmp(arguments[1], "check") == 0;
    for (int w = 0; w < WAY_COUNT; w++) {
        const struct way *way = &WAYS[w];
        for (int k = 0; k < COUNT; k++) {
            for (int i = 0; i < way->joints; i++) {
                const double angle = 2.0 * sin(1.7 * k + 2.3 * i);
                poses[k * way->joints + i] = angles[i][k] = angle;
                angles_f32[i][k] = (float)angle;
            }
        }
        printf("%s\t%s\t%s", way->robot, way->quantity, way->name);
        if (check) {
            pass(way);
            for (int k = 0; k < CHECKED; k++)
                for (int e = 0; e < way->size; e++) printf("\t%.17g", entry(way, k, e));
        } else {
            printf("\t%.17g", least(way));
        }
        printf("\n");
    }
}
