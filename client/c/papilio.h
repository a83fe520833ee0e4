#ifndef PAPILIO_H
#define PAPILIO_H

/* NOLINTBEGIN(modernize-*): this is C */

#include <stdint.h>

/* Refinement for programs in C, and in all languages that call C. The arrays of a mesh are those that graphics
   libraries use; parameters are those of the service, written as in a query: "tolerance=0.001&levels=4".

   A function that fails returns NULL; papilio_last_fault() and papilio_last_message() then say why. */

#ifdef __cplusplus
extern "C" {
#endif

/* Why a call failed. */
typedef enum papilio_fault {
  PAPILIO_NO_FAULT = 0,
  PAPILIO_BAD_PARAMETER = 1, /* unknown, malformed or out of range: papilio_last_parameter() */
  PAPILIO_UNUSABLE_MESH = 2, /* no faces, indices that name no point, coordinates that are not finite */
  PAPILIO_TOO_LARGE = 3,     /* the result would pass 16 million faces or the memory of a 32-bit program */
  PAPILIO_CANCELLED = 4,     /* papilio_hooks.cancelled returned other than 0 */
  PAPILIO_OUT_OF_MEMORY = 5,
  PAPILIO_INTERNAL = 6 /* a bug of the library */
} papilio_fault;

/* What becomes of an attribute's values. */
typedef enum papilio_attribute_kind {
  PAPILIO_VALUES = 0,           /* interpolated: texture coordinates, colours */
  PAPILIO_NORMALS = 1,          /* 3 components: those of the refined surface, split where the input splits them */
  PAPILIO_SMOOTHING_GROUPS = 2, /* 1 component: faces of different groups, or of group 0, meet at creases */
  PAPILIO_DISPLACEMENTS = 3     /* 3 components: moves the refined surface as a morph target moves the coarse mesh */
} papilio_attribute_kind;

typedef struct papilio_attribute {
  uint32_t components;  /* 1 or more */
  int32_t kind;         /* papilio_attribute_kind */
  const double* values; /* [point_count * components] */
} papilio_attribute;

/* Indexed triangles. Points of equal position are one vertex, and with different attributes a seam. */
typedef struct papilio_triangles {
  uint32_t point_count, face_count, attribute_count;
  const float* positions;    /* [point_count * 3] */
  const uint32_t* triangles; /* [face_count * 3] counter-clockwise, seen from outside */
  const papilio_attribute* attributes;
} papilio_triangles;

typedef enum papilio_stop_reason {
  PAPILIO_CONVERGED = 0, /* nothing was left to split */
  PAPILIO_LEVELS = 1,    /* all levels asked for were made */
  PAPILIO_BUDGET = 2,    /* max_faces kept something out */
  PAPILIO_LIMITS = 3     /* a further level would have been too large */
} papilio_stop_reason;

typedef struct papilio_statistics {
  int32_t level;       /* of this mesh; 0: the coarse mesh */
  int32_t is_last;     /* 0 or 1; what follows holds of the last level only */
  int32_t stop_reason; /* papilio_stop_reason */
  uint32_t components; /* parts of the mesh that the shape rules looked at */
  uint32_t mechanical; /* of these taken for mechanical */
  uint32_t creases;    /* edges of the coarse mesh kept sharp */
  double error;        /* largest deviation left, as a share of the coarse mesh's diagonal */
  double error_pixels; /* the same in pixels of the view; 0 without one */
} papilio_statistics;

/* How the caller takes part. Functions may be NULL. All are called on the calling thread. */
typedef struct papilio_hooks {
  void* user; /* handed to the functions */
  /* Called every few milliseconds; other than 0 stops with PAPILIO_CANCELLED. */
  int (*cancelled)(void* user);
  /* Called with each level, coarse first, while the call lasts; the arrays are the library's. */
  void (*on_level)(void* user, const papilio_triangles* mesh, const papilio_statistics* statistics);
  int32_t threads; /* work on it at most so many; the result is the same to the bit */
} papilio_hooks;

typedef struct papilio_mesh papilio_mesh;     /* a coarse mesh, and what its refinements have in common */
typedef struct papilio_result papilio_result; /* a refined mesh */

/* "1.2.3" */
const char* papilio_version(void);

/* Copies the arrays. Free with papilio_mesh_free. A mesh is for one thread at a time. */
papilio_mesh* papilio_mesh_create(const papilio_triangles* triangles);
void papilio_mesh_free(papilio_mesh* mesh); /* NULL does nothing */

/* Refines the mesh. `parameters` are fields of a query, percent-encoded, NULL or "" for the defaults; those of the
   encoding (output.position_bits, output.speed, output.compress) have no effect. `hooks` may be NULL. Views of one mesh
   cost less after the first. Free with papilio_result_free. */
papilio_result* papilio_refine(papilio_mesh* mesh, const char* parameters, const papilio_hooks* hooks);
/* The arrays are the result's. Attributes are those of the mesh, in their order; output.normals=true appends normals to
   a mesh without. */
const papilio_triangles* papilio_result_mesh(const papilio_result* result);
const papilio_statistics* papilio_result_statistics(const papilio_result* result);
void papilio_result_free(papilio_result* result); /* NULL does nothing */

/* Of the last call on this thread that failed. Texts are never NULL and last until the next failure. */
papilio_fault papilio_last_fault(void);
const char* papilio_last_message(void);   /* what is wrong and what to do, one or two sentences */
const char* papilio_last_parameter(void); /* the parameter's name, or "" */

#ifdef __cplusplus
}
#endif

/* NOLINTEND(modernize-*) */

#endif
