# SPDX-License-Identifier: Apache-2.0
# The modules of src/ by wing, from the lowest to the highest. A module links those before it only.
set(takt_modules
    protocol/uadp protocol/security protocol/program protocol/handshake protocol/pubsub protocol/wire protocol/dds
    protocol/gateway protocol/opcua
    foundation/json foundation/plant foundation/application foundation/schedule foundation/xml
    foundation/schedule_instances
    simulation/results simulation/scenario simulation/evaluation simulation/explain
    questions/analysis questions/explore questions/profile questions/schedule_check questions/verify questions/synthesis
    presentation/chart presentation/output presentation/report
    exchange/interchange
    experiments/study experiments/papers experiments/property
    device/node device/emulate
    frontends/python frontends/studio frontends/cli)
set(takt_wings ${takt_modules})
list(TRANSFORM takt_wings REPLACE "/.*" "")
list(REMOVE_DUPLICATES takt_wings)
