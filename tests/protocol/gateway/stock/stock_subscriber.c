// usage: stock_subscriber Sample|Blob|Motion DOMAIN COUNT
// Takes COUNT samples of the topic and prints each as a line of JSON; "matched" when it has found a writer.
#include <inttypes.h>

#include "stock.h"

static void print_sample(const Plant_Sample* s) {
  printf("{\"on\": %d, \"tiny\": %d, \"raw\": %u, \"small\": %d, \"usmall\": %u, \"number\": %" PRId32 ", \"unumber\": %" PRIu32 ", \"big\": %" PRId64 ", \"ubig\": %" PRIu64, s->on, s->tiny, s->raw,
         s->small, s->usmall, s->number, s->unumber, s->big, s->ubig);
  printf(", \"ratio\": %.9g, \"speed\": %.17g, \"name\": \"%s\", \"label\": \"%s\", \"id\": [%" PRIu32 ", %u, %u", s->ratio, s->speed, s->name, s->label, s->id.data1, s->id.data2, s->id.data3);
  for (int i = 0; i < 8; ++i) printf(", %u", s->id.data4[i]);
  printf("], \"axes\": [");
  for (int i = 0; i < 6; ++i) printf("%s%.17g", i ? ", " : "", s->axes[i]);
  printf("], \"flags\": [%d, %d, %d], \"blob\": [", s->flags[0], s->flags[1], s->flags[2]);
  for (uint32_t i = 0; i < s->blob._length; ++i) printf("%s%u", i ? ", " : "", s->blob._buffer[i]);
  printf("], \"path\": [");
  for (uint32_t i = 0; i < s->path._length; ++i) printf("%s%.17g", i ? ", " : "", s->path._buffer[i]);
  printf("], \"words\": [");
  for (uint32_t i = 0; i < s->words._length; ++i) printf("%s\"%s\"", i ? ", " : "", s->words._buffer[i]);
  printf("], \"stamp\": %" PRId64 ", \"status\": %" PRIu32 "}\n", s->stamp, s->status);
}

static void print_motion(const Plant_Motion* m) {
  printf("{\"counter\": %" PRIu32 ", \"speed\": %.17g, \"axes\": [%d, %d, %d], \"on\": %d}\n", m->counter, m->speed, m->axes[0], m->axes[1], m->axes[2], m->on);
}

static void print_blob(const Plant_Blob* b) {
  uint32_t sum = 0;
  for (uint32_t i = 0; i < b->data._length; ++i) sum = 31 * sum + b->data._buffer[i];
  printf("{\"number\": %" PRIu32 ", \"octets\": %" PRIu32 ", \"sum\": %" PRIu32 "}\n", b->number, b->data._length, sum);
}

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const char* const type = arguments[1];
  const dds_entity_t participant = checked(dds_create_participant((dds_domainid_t)atoi(arguments[2]), NULL, NULL), "participant");
  const dds_entity_t topic = checked(dds_create_topic(participant, descriptor_of(type), type, NULL, NULL), "topic");
  dds_qos_t* const qos = reliable();
  const dds_entity_t reader = checked(dds_create_reader(participant, topic, qos, NULL), "reader");
  dds_delete_qos(qos);
  printf("ready\n");
  fflush(stdout);
  int is_matched = 0;
  for (int left = atoi(arguments[3]); left > 0;) {
    dds_subscription_matched_status_t status;
    if (!is_matched && dds_get_subscription_matched_status(reader, &status) == DDS_RETCODE_OK && status.current_count > 0) {
      is_matched = 1;
      printf("matched\n");
    }
    void* sample = NULL;
    dds_sample_info_t info;
    const int taken = dds_take(reader, &sample, &info, 1, 1);
    if (taken > 0 && info.valid_data) {
      if (is_sample(type))
        print_sample(sample);
      else if (is_blob(type))
        print_blob(sample);
      else
        print_motion(sample);
      --left;
    }
    if (taken > 0) dds_return_loan(reader, &sample, taken);
    fflush(stdout);
    if (taken == 0) dds_sleepfor(DDS_MSECS(2));
  }
  dds_delete(participant);
  return 0;
}
