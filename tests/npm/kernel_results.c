/* kernel_results MESH [--times]: refines a mesh by the C functions, for each line of standard input as parameters, and
   writes the result to standard output, as requests.mjs reads it. The mesh is opened anew for each line.

   MESH: uint32 points, faces, attributes; of each attribute uint32 components, kind; float positions, uint32
   triangles, double values of each attribute.
   Result: uint32 fault, then of a failure the texts of the message and the parameter, each ended by 0; else
   papilio_statistics and a MESH. With --times: a line with the milliseconds of the refinement. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "client/c/papilio.h"

static void* take(FILE* file, size_t count, size_t size) {
  void* values = malloc(count * size + 1);
  if (values == NULL || fread(values, size, count, file) != count) {
    fputs("kernel_results: the mesh cannot be read\n", stderr);
    exit(2);
  }
  return values;
}

static void give(const void* values, size_t count, size_t size) {
  if (fwrite(values, size, count, stdout) != count) exit(1);
}

static papilio_triangles read_mesh(const char* name) {
  papilio_triangles mesh;
  papilio_attribute* attributes;
  uint32_t* head;
  uint32_t* rows;
  uint32_t a;
  FILE* file = fopen(name, "rb");
  if (file == NULL) {
    perror(name);
    exit(2);
  }
  head = take(file, 3, sizeof *head);
  rows = take(file, 2 * (size_t)head[2], sizeof *rows);
  mesh.point_count = head[0];
  mesh.face_count = head[1];
  mesh.attribute_count = head[2];
  mesh.positions = take(file, 3 * (size_t)head[0], sizeof(float));
  mesh.triangles = take(file, 3 * (size_t)head[1], sizeof(uint32_t));
  attributes = malloc((head[2] + 1) * sizeof *attributes);
  if (attributes == NULL) exit(2);
  for (a = 0; a < head[2]; ++a) {
    attributes[a].components = rows[2 * a];
    attributes[a].kind = (int32_t)rows[2 * a + 1];
    attributes[a].values = take(file, (size_t)head[0] * rows[2 * a], sizeof(double));
  }
  mesh.attributes = attributes;
  fclose(file);
  return mesh; /* its arrays are needed to the end */
}

static void write_mesh(const papilio_triangles* mesh) {
  uint32_t a;
  give(&mesh->point_count, 1, sizeof(uint32_t));
  give(&mesh->face_count, 1, sizeof(uint32_t));
  give(&mesh->attribute_count, 1, sizeof(uint32_t));
  for (a = 0; a < mesh->attribute_count; ++a) {
    give(&mesh->attributes[a].components, 1, sizeof(uint32_t));
    give(&mesh->attributes[a].kind, 1, sizeof(uint32_t));
  }
  give(mesh->positions, 3 * (size_t)mesh->point_count, sizeof(float));
  give(mesh->triangles, 3 * (size_t)mesh->face_count, sizeof(uint32_t));
  for (a = 0; a < mesh->attribute_count; ++a)
    give(mesh->attributes[a].values, (size_t)mesh->point_count * mesh->attributes[a].components, sizeof(double));
}

static double now(void) {
  struct timespec at;
  clock_gettime(CLOCK_MONOTONIC, &at);
  return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

static void write_result(const papilio_result* result) {
  const uint32_t fault = result == NULL ? papilio_last_fault() : PAPILIO_NO_FAULT;
  give(&fault, 1, sizeof fault);
  if (result == NULL) {
    give(papilio_last_message(), strlen(papilio_last_message()) + 1, 1);
    give(papilio_last_parameter(), strlen(papilio_last_parameter()) + 1, 1);
  } else {
    give(papilio_result_statistics(result), 1, sizeof(papilio_statistics));
    write_mesh(papilio_result_mesh(result));
  }
}

int main(int argc, char** argv) {
  char line[4096];
  papilio_triangles coarse;
  const int is_timed = argc == 3 && strcmp(argv[2], "--times") == 0;
  if (argc != 2 + is_timed) {
    fputs("usage: kernel_results MESH [--times] <PARAMETERS\n", stderr);
    return 2;
  }
  coarse = read_mesh(argv[1]);
  while (fgets(line, sizeof line, stdin) != NULL) {
    papilio_mesh* mesh = papilio_mesh_create(&coarse);
    const double began = now();
    papilio_result* result;
    line[strcspn(line, "\n")] = 0;
    result = mesh == NULL ? NULL : papilio_refine(mesh, line, NULL);
    if (is_timed) {
      if (result == NULL) return 1;
      printf("%.4f\n", 1000 * (now() - began));
      fflush(stdout);
    } else {
      write_result(result);
    }
    papilio_result_free(result);
    papilio_mesh_free(mesh);
  }
  return 0;
}
