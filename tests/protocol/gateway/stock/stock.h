// What the stock programs have in common. Nothing of takt is in them: they are what somebody else would write for Cyclone DDS.
#pragma once

#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plant.h"

static inline int is_sample(const char* type) { return strcmp(type, "Sample") == 0; }

static inline int is_blob(const char* type) { return strcmp(type, "Blob") == 0; }

static inline const dds_topic_descriptor_t* descriptor_of(const char* type) { return is_sample(type) ? &Plant_Sample_desc : is_blob(type) ? &Plant_Blob_desc : &Plant_Motion_desc; }

static inline dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity < 0) {
    fprintf(stderr, "%s: %s\n", what, dds_strretcode(entity));
    exit(3);
  }
  return entity;
}

/// Reliable, nothing is replaced before it is taken, and who matches late gets all of it: a reader may not know of a writer yet that knows of it.
static inline dds_qos_t* reliable(void) {
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_ALL, 0, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  return qos;
}
