#ifndef PAPILIO_H
#define PAPILIO_H

/* NOLINTBEGIN(modernize-*): this is C */

#include <stdint.h>

/* Refinement for C, and for all languages that call C. Meshes are indexed arrays, as in graphics libraries. Parameters
   are those of the service, written as in a query: "tolerance=0.001&levels=4".

   A function that fails returns NULL; papilio_last_fault() and papilio_last_message() return the cause. */

#ifdef __cplusplus
extern "C" {
#endif

/* Cause of a failed call. */
typedef enum papilio_fault {
  PAPILIO_NO_FAULT = 0,
  PAPILIO_BAD_PARAMETER = 1, /* an unknown or malformed parameter, or a value out of range: papilio_last_parameter() */
  PAPILIO_UNUSABLE_MESH = 2, /* no faces, indices out of range, or coordinates that are not finite */
  PAPILIO_TOO_LARGE = 3,     /* the result would exceed 16 million faces or the memory of a 32-bit program */
  PAPILIO_CANCELLED = 4,     /* papilio_hooks.cancelled returned a value other than 0 */
  PAPILIO_OUT_OF_MEMORY = 5,
  PAPILIO_INTERNAL = 6 /* a bug of the library */
} papilio_fault;

/* Kind of an attribute, which defines its refinement. */
typedef enum papilio_attribute_kind {
  PAPILIO_VALUES = 0,           /* values to interpolate, such as texture coordinates or colours */
  PAPILIO_NORMALS = 1,          /* 3 components: recomputed from the refined surface, and split as in the input */
  PAPILIO_SMOOTHING_GROUPS = 2, /* 1 component: faces of different groups meet at creases */
  PAPILIO_DISPLACEMENTS = 3     /* 3 components: displacements of a morph target, refined as the surface is */
} papilio_attribute_kind;

typedef struct papilio_attribute {
  uint32_t components;  /* 1 or more */
  int32_t kind;         /* papilio_attribute_kind */
  const double* values; /* [point_count * components] */
} papilio_attribute;

/* Indexed triangles. Points of equal position are one vertex; with different attributes they form a seam. */
typedef struct papilio_triangles {
  uint32_t point_count, face_count, attribute_count;
  const float* positions;    /* [point_count * 3] */
  const uint32_t* triangles; /* [face_count * 3] counter-clockwise, seen from outside */
  const papilio_attribute* attributes;
} papilio_triangles;

typedef enum papilio_stop_reason {
  PAPILIO_CONVERGED = 0, /* no edge was left to split */
  PAPILIO_LEVELS = 1,    /* all requested levels were made */
  PAPILIO_BUDGET = 2,    /* max_faces was reached */
  PAPILIO_LIMITS = 3     /* a further level would have been too large */
} papilio_stop_reason;

typedef struct papilio_statistics {
  int32_t level;       /* level of this mesh; 0: the coarse mesh */
  int32_t is_last;     /* 0 or 1; the fields that follow are set for the last level only */
  int32_t stop_reason; /* papilio_stop_reason */
  uint32_t components; /* components of the mesh under the shape rules */
  uint32_t mechanical; /* mechanical components */
  uint32_t creases;    /* creases among the edges of the coarse mesh */
  double error;        /* largest deviation left, as a share of the coarse mesh's diagonal */
  double error_pixels; /* largest deviation left in pixels of the view; 0 without a view */
} papilio_statistics;

/* Callbacks and threads. Functions may be NULL. All are called on the calling thread. */
typedef struct papilio_hooks {
  void* user; /* argument of the functions */
  /* Called every few milliseconds; a value other than 0 stops with PAPILIO_CANCELLED. */
  int (*cancelled)(void* user);
  /* Called with each level, coarse first. The library owns the arrays, which are valid during the call. */
  void (*on_level)(void* user, const papilio_triangles* mesh, const papilio_statistics* statistics);
  int32_t threads; /* upper bound of the threads at work; the result is bit-identical for any number */
} papilio_hooks;

typedef struct papilio_mesh papilio_mesh;     /* coarse mesh, with data shared by its refinements */
typedef struct papilio_result papilio_result; /* refined mesh */

/* Returns the version, such as "1.2.3". */
const char* papilio_version(void);

/* Creates a mesh; copies the arrays. Free it with papilio_mesh_free. Use it on one thread at a time. */
papilio_mesh* papilio_mesh_create(const papilio_triangles* triangles);
void papilio_mesh_free(papilio_mesh* mesh); /* NULL does nothing */

/* Refines the mesh. `parameters` are fields of a query, percent-encoded; NULL or "" for the defaults. Parameters of the
   encoding (output.position_bits, output.speed, output.compress) have no effect. `hooks` may be NULL. Further views of
   a mesh cost less than the first. Free the result with papilio_result_free. */
papilio_result* papilio_refine(papilio_mesh* mesh, const char* parameters, const papilio_hooks* hooks);
/* Returns the refined mesh; the result owns the arrays. Attributes are those of the mesh, in their order;
   output.normals=true appends normals to a mesh without normals. */
const papilio_triangles* papilio_result_mesh(const papilio_result* result);
const papilio_statistics* papilio_result_statistics(const papilio_result* result);
void papilio_result_free(papilio_result* result); /* NULL does nothing */

/* Describe the last failed call on this thread. Texts are never NULL, and valid until the next failure. */
papilio_fault papilio_last_fault(void);
const char* papilio_last_message(void);   /* the problem and its remedy, in one or two sentences */
const char* papilio_last_parameter(void); /* name of the parameter at fault, or "" */

#ifdef __cplusplus
}
#endif

/* NOLINTEND(modernize-*) */

#endif
