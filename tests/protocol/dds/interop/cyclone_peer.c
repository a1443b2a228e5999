// A stock Cyclone DDS program for the tests: publishes, subscribes, or sends back what it gets.
//
//   takt_cyclone_peer publish TOPIC COUNT PERIOD_MS    waits for a reader, writes COUNT samples, waits until all are acknowledged
//   takt_cyclone_peer subscribe TOPIC COUNT            prints COUNT samples
//   takt_cyclone_peer echo FROM TO COUNT               writes to TO what comes from FROM, COUNT times
//
// Exit status: 0, or 1 if nothing came for 20 s.
#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sample.h"

enum { patience_s = 20 };

static dds_entity_t participant;

static void fail(const char* what) {
  fprintf(stderr, "%s\n", what);
  exit(1);
}

static dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity < 0) fail(what);
  return entity;
}

static dds_qos_t* reliable_all(void) {
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  // Cyclone limits by it, too, what a late reader gets; else that is the last sample of each instance.
  dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_ALL, 0, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  return qos;
}

static dds_entity_t topic_of(const char* name) { return checked(dds_create_topic(participant, &TaktInterop_Sample_desc, name, NULL, NULL), "no topic"); }
static dds_entity_t reader_of(const char* topic) { return checked(dds_create_reader(participant, topic_of(topic), reliable_all(), NULL), "no reader"); }
static dds_entity_t writer_of(const char* topic) { return checked(dds_create_writer(participant, topic_of(topic), reliable_all(), NULL), "no writer"); }

static void wait_for(dds_entity_t entity, uint32_t status) {
  const dds_entity_t set = checked(dds_create_waitset(participant), "no waitset");
  dds_set_status_mask(entity, status);
  dds_waitset_attach(set, entity, 0);
  if (dds_waitset_wait(set, NULL, 0, DDS_SECS(patience_s)) <= 0) fail("nothing came");
  dds_delete(set);
}

static void publish(dds_entity_t writer, TaktInterop_Sample* sample) {
  if (dds_write(writer, sample) < 0) fail("not written");
}

/// Takes samples until there were `count`; writes each to `writer`, if there is one.
static void take(dds_entity_t reader, int count, dds_entity_t writer) {
  for (int taken = 0; taken < count;) {
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    const int got = dds_take(reader, samples, info, 1, 1);
    if (got <= 0) {
      wait_for(reader, DDS_DATA_AVAILABLE_STATUS);
      continue;
    }
    if (info[0].valid_data) {
      TaktInterop_Sample* const sample = samples[0];
      printf("sample %d %lld %s\n", sample->id, (long long)sample->count, sample->text);
      fflush(stdout);
      if (writer > 0) publish(writer, sample);
      ++taken;
    }
    dds_return_loan(reader, samples, got);
  }
}

int main(int argc, char** argv) {
  if (argc < 4) fail("publish TOPIC COUNT PERIOD_MS | subscribe TOPIC COUNT | echo FROM TO COUNT");
  participant = checked(dds_create_participant(DDS_DOMAIN_DEFAULT, NULL, NULL), "no participant");
  if (strcmp(argv[1], "publish") == 0 && argc == 5) {
    const dds_entity_t writer = writer_of(argv[2]);
    wait_for(writer, DDS_PUBLICATION_MATCHED_STATUS);
    dds_sleepfor(DDS_MSECS(200));
    for (int i = 1; i <= atoi(argv[3]); ++i) {
      TaktInterop_Sample sample = {1, i, (char*)"from Cyclone"};
      publish(writer, &sample);
      dds_sleepfor(DDS_MSECS(atoi(argv[4])));
    }
    if (dds_wait_for_acks(writer, DDS_SECS(patience_s)) < 0) fail("not acknowledged");
  } else if (strcmp(argv[1], "subscribe") == 0) {
    take(reader_of(argv[2]), atoi(argv[3]), 0);
  } else if (strcmp(argv[1], "echo") == 0 && argc == 5) {
    const dds_entity_t writer = writer_of(argv[3]);
    wait_for(writer, DDS_PUBLICATION_MATCHED_STATUS);  // else it may have left before anybody reads
    take(reader_of(argv[2]), atoi(argv[4]), writer);
    if (dds_wait_for_acks(writer, DDS_SECS(patience_s)) < 0) fail("not acknowledged");
  } else {
    fail("what?");
  }
  dds_delete(participant);
  return 0;
}
