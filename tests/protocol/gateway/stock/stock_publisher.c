// usage: stock_publisher Sample|Blob|Motion DOMAIN COUNT MILLISECONDS
// When a reader has been found, writes COUNT samples, each MILLISECONDS behind the one before; then waits until all are acknowledged.
// What the members of sample number n are can be read below.
#include "stock.h"

static void write_sample(dds_entity_t writer, uint32_t n) {
  Plant_Sample s;
  char name[32], label[17], text[3][32];
  char* words[3] = {text[0], text[1], text[2]};
  uint8_t blob[8];
  double path[8];
  memset(&s, 0, sizeof s);
  s.on = n % 2 == 1;
  s.tiny = (int8_t)-(int)(n % 100);
  s.raw = (uint8_t)n;
  s.small = (int16_t)-(int)n;
  s.usmall = (uint16_t)(3 * n);
  s.number = -(int32_t)(n * 100003u);
  s.unumber = n * 40000003u;
  s.big = -(int64_t)n * 1000000000000;
  s.ubig = (uint64_t)n * 1000000000000000u;
  s.ratio = 0.5f * (float)n;
  s.speed = 0.25 * n + 0.001;
  snprintf(name, sizeof name, "sample %u", n);
  snprintf(label, sizeof label, "L%u", n % 1000);
  s.name = name;
  strcpy(s.label, label);
  s.id.data1 = n;
  s.id.data2 = (uint16_t)n;
  s.id.data3 = 7;
  for (uint32_t i = 0; i < 8; ++i) s.id.data4[i] = (uint8_t)(n + i);
  for (uint32_t i = 0; i < 6; ++i) s.axes[i] = n + 0.125 * i;
  for (uint32_t i = 0; i < 3; ++i) s.flags[i] = (n >> i) % 2 == 1;
  for (uint32_t i = 0; i < 8; ++i) blob[i] = (uint8_t)(n + i);
  s.blob._buffer = blob;
  s.blob._length = s.blob._maximum = n % 5;
  for (uint32_t i = 0; i < 8; ++i) path[i] = 0.5 * i - n;
  s.path._buffer = path;
  s.path._length = s.path._maximum = n % 9;
  for (uint32_t i = 0; i < 3; ++i) snprintf(text[i], sizeof text[i], "w%u-%u", i, n);
  s.words._buffer = words;
  s.words._length = s.words._maximum = n % 4;
  s.stamp = 132000000000000000 + (int64_t)n;
  s.status = 0x80000000u | n;
  checked(dds_write(writer, &s), "write");
}

static void write_motion(dds_entity_t writer, uint32_t n) {
  const Plant_Motion m = {n, 0.25 * n, {(int16_t)n, (int16_t)-(int)n, 7}, n % 2 == 1};
  checked(dds_write(writer, &m), "write");
}

/// Longer and longer: Cyclone sends fragments.
static void write_blob(dds_entity_t writer, uint32_t n) {
  uint8_t data[70000];
  Plant_Blob b;
  memset(&b, 0, sizeof b);
  b.number = n;
  b.data._buffer = data;
  b.data._length = b.data._maximum = 1003 * n;
  for (uint32_t i = 0; i < b.data._length; ++i) data[i] = (uint8_t)(7 * i + n);
  checked(dds_write(writer, &b), "write");
}

int main(int count, char** arguments) {
  if (count != 5) return 2;
  const char* const type = arguments[1];
  const dds_entity_t participant = checked(dds_create_participant((dds_domainid_t)atoi(arguments[2]), NULL, NULL), "participant");
  const dds_entity_t topic = checked(dds_create_topic(participant, descriptor_of(type), type, NULL, NULL), "topic");
  dds_qos_t* const qos = reliable();
  const dds_entity_t writer = checked(dds_create_writer(participant, topic, qos, NULL), "writer");
  dds_delete_qos(qos);
  dds_publication_matched_status_t status = {0};
  while (status.current_count == 0) {
    dds_sleepfor(DDS_MSECS(5));
    checked(dds_get_publication_matched_status(writer, &status), "status");
  }
  printf("matched\n");
  fflush(stdout);
  for (uint32_t n = 1; n <= (uint32_t)atoi(arguments[3]); ++n) {
    if (is_sample(type))
      write_sample(writer, n);
    else if (is_blob(type))
      write_blob(writer, n);
    else
      write_motion(writer, n);
    dds_sleepfor(DDS_MSECS(atoi(arguments[4])));
  }
  checked(dds_wait_for_acks(writer, DDS_INFINITY), "acknowledgements");
  dds_delete(participant);
  return 0;
}
