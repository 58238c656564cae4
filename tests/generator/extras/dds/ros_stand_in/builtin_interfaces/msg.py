from cdr import Message


class Time(Message):
    DDS = "builtin_interfaces::msg::dds_::Time_"
    FIELDS = (("sec", "int32"), ("nanosec", "uint32"))
