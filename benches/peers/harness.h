/* What a C or C++ peer gives to harness.c: a table of its functions. */
#pragma once
#ifdef __cplusplus
extern "C" {
#endif

/* Not a power of two: arrays of such a length fall into the same lines of the cache. */
enum { COUNT = 1008 };

/* One of the three is there: one pose, or all poses with an array a joint and an
   array an entry, in either precision. */
struct way {
    const char *robot, *quantity, *name;
    int joints, size;
    void (*one)(const double *q, double *out);
    void (*all)(const double (*q)[COUNT], double (*out)[COUNT]);
    void (*all_f32)(const float (*q)[COUNT], float (*out)[COUNT]);
};

extern const struct way WAYS[];
extern const int WAY_COUNT;

#ifdef __cplusplus
}
#endif
