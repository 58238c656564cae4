#!/usr/bin/env bash
# A Slurm cluster of two nodes on this machine, for tests: to be sourced, after which start_cluster
# and stop_cluster exist. Everything lies in one folder; nothing of the machine's own Slurm, if it
# has one, is touched. Needs root, because slurmd starts jobs as their users.

# start_cluster FOLDER: sets SLURM_CONF, so that sbatch and the others find this cluster.
start_cluster() {
  local folder=$1 host memory
  host=$(hostname -s)
  memory=$(awk '/MemTotal/ {print int($2 / 2048 / 2)}' /proc/meminfo)
  mkdir -p "$folder"/{state,spool1,spool2,log}
  chmod 755 "$folder"
  head -c 1024 /dev/urandom > "$folder/munge.key"
  chmod 400 "$folder/munge.key"
  cat > "$folder/slurm.conf" << CONF
ClusterName=throwaway
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=17817
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CryptoType=crypto/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd%n.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
MinJobAge=600
KillWait=1
MaxArraySize=10001
NodeName=1 NodeHostname=$host NodeAddr=127.0.0.1 Port=17818 CPUs=1 RealMemory=$memory
NodeName=2 NodeHostname=$host NodeAddr=127.0.0.1 Port=17819 CPUs=1 RealMemory=$memory
PartitionName=all Nodes=1,2 Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$folder/slurm.conf
  munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --log-file="$folder/log/munged.log" \
    --seed-file="$folder/munge.seed"
  slurmctld -i
  slurmd -N 1
  slurmd -N 2
  local tries
  for tries in $(seq 50); do
    if [[ $(sinfo -h -N -t idle -o %N 2> /dev/null | wc -l) == 2 ]]; then return 0; fi
    sleep 0.2
  done
  echo "error: the nodes do not come up after $tries looks; see $folder/log" >&2
  return 1
}

# stop_cluster FOLDER
stop_cluster() {
  local folder=$1 name
  scancel --user="$(id -un)" 2> /dev/null || true
  for name in slurmd1 slurmd2 slurmctld munged; do
    if [[ -f $folder/$name.pid ]]; then kill "$(cat "$folder/$name.pid")" 2> /dev/null || true; fi
  done
}
