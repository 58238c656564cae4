find_library(PCAP_LIBRARY pcap REQUIRED)
railcast_import(pcap ${PCAP_LIBRARY})
