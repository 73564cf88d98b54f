"""Reads logs of Fresco's traffic: LCM event logs, as `fresco train --record`, `fresco log record` and lcm-logger write
them. It needs nothing but Python.

    import fresco_log
    log = fresco_log.EventLog("runs/NAME/traffic.lcm")      # several paths are read as one log
    for event in log:                                       # in the order of time
        print(event.utime, event.channel, event.message)    # an object of fresco_log.fresco, e.g. run_t
    for status in log.messages("learner_status_t"):
        print(status.episodes, status.loss)
    transitions = pandas.DataFrame(log.transitions())       # a row for each transition
    statuses = pandas.DataFrame(map(fresco_log.as_dict, log.messages("actor_status_t")))

The .lcm files in msgs/lcm explain the fields of messages.
"""
from .event_log import Event, EventLog
from .message import as_dict, decode, type_name

__all__ = ["Event", "EventLog", "as_dict", "decode", "type_name"]
