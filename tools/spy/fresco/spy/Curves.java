package fresco.spy;

import info.monitorenter.gui.chart.Chart2D;
import info.monitorenter.gui.chart.IAxis;
import info.monitorenter.gui.chart.ITrace2D;
import info.monitorenter.gui.chart.ITracePoint2D;
import info.monitorenter.gui.chart.axis.AAxis;
import info.monitorenter.gui.chart.axis.AxisLinear;
import info.monitorenter.gui.chart.axis.scalepolicy.AxisScalePolicyManualTicks;
import info.monitorenter.gui.chart.labelformatters.LabelFormatterNumber;
import info.monitorenter.gui.chart.rangepolicies.RangePolicyFixedViewport;
import info.monitorenter.gui.chart.traces.Trace2DLtd;
import info.monitorenter.util.Range;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Font;
import java.text.DecimalFormat;
import java.text.DecimalFormatSymbols;
import java.util.Iterator;
import java.util.List;
import java.util.Locale;
import javax.swing.BorderFactory;
import javax.swing.JLabel;
import javax.swing.JPanel;

/** A chart of growing curves with a heading, axes with units and a legend. Used on the event thread. */
final class Curves extends JPanel {
  private static final long serialVersionUID = 1;
  private static final int POINTS = 4000; // of a curve; the oldest are dropped
  private static final int X_TICKS = 10;
  private static final int Y_TICKS = 6;

  private final transient Chart2D chart = new Chart2D();

  Curves(String heading, String xTitle, String yTitle) {
    super(new BorderLayout());
    setBackground(Palette.SURFACE);
    setBorder(BorderFactory.createEmptyBorder(6, 8, 2, 8));
    JLabel label = new JLabel(heading);
    label.setFont(label.getFont().deriveFont(Font.BOLD, 13f));
    label.setForeground(Palette.INK);
    add(label, BorderLayout.NORTH);
    chart.setBackground(Palette.SURFACE);
    chart.setForeground(Palette.MUTED);
    chart.setGridColor(Palette.LINE);
    chart.setUseAntialiasing(true);
    chart.setFont(chart.getFont().deriveFont(Font.PLAIN, 11f));
    chart.setToolTipType(Chart2D.ToolTipType.VALUE_SNAP_TO_TRACEPOINTS);
    chart.setAxisXBottom(axisWithOurTicks(), 0);
    chart.setAxisYLeft(axisWithOurTicks(), 0);
    prepare(chart.getAxisX(), xTitle); // now, since a new axis takes over the title of the old one
    prepare(chart.getAxisY(), yTitle);
    add(chart, BorderLayout.CENTER);
  }

  private static AAxis<?> axisWithOurTicks() {
    AxisLinear<AxisScalePolicyManualTicks> axis = new AxisLinear<>();
    axis.setAxisScalePolicy(new AxisScalePolicyManualTicks());
    return axis;
  }

  private static void prepare(IAxis<?> axis, String title) {
    axis.setAxisTitle(new IAxis.AxisTitle(title));
    axis.setPaintGrid(true);
    DecimalFormat format = new DecimalFormat("#,##0.####", DecimalFormatSymbols.getInstance(Locale.ROOT));
    axis.setFormatter(new LabelFormatterNumber(format));
  }

  ITrace2D add(String name, Color colour, double width) {
    ITrace2D trace = new Trace2DLtd(POINTS, name);
    trace.setColor(colour);
    trace.setStroke(Palette.stroke(width));
    trace.setPhysicalUnits("", "");
    chart.addTrace(trace);
    trace.setName(name);
    return trace;
  }

  void remove(ITrace2D trace) { chart.removeTrace(trace); }

  /** Sets the range of the x axis, whatever points the curves have. */
  void setXRange(double from, double to) {
    setRange(chart.getAxisX(), from, Math.max(to, from + 1), X_TICKS);
  }

  void setYRange(double from, double to) {
    setRange(chart.getAxisY(), from, Math.max(to, from + 1), Y_TICKS);
  }

  /** Fits the y axis to the curves. It begins at zero unless they stay far above that. */
  void fitY() { fitYFrom(-Double.MAX_VALUE); }

  /** Fits it to the newer half of the curves: those that fall fast at first are legible afterwards. */
  void fitYToNewerHalf() {
    List<ITrace2D> drawn = chart.getTraces().stream().filter(trace -> !trace.isEmpty()).toList();
    double first = drawn.stream().mapToDouble(ITrace2D::getMinX).min().orElse(0);
    double last = drawn.stream().mapToDouble(ITrace2D::getMaxX).max().orElse(0);
    fitYFrom((first + last) / 2);
  }

  private void fitYFrom(double x) {
    double low = Double.MAX_VALUE;
    double high = -Double.MAX_VALUE;
    for (ITrace2D trace : chart.getTraces()) {
      for (Iterator<ITracePoint2D> points = trace.iterator(); points.hasNext();) {
        ITracePoint2D point = points.next();
        if (point.getX() >= x) {
          low = Math.min(low, point.getY());
          high = Math.max(high, point.getY());
        }
      }
    }
    fitYTo(low, high);
  }

  private void fitYTo(double low, double high) {
    if (low > high) { // there is no point yet
      setRange(chart.getAxisY(), 0, 1, Y_TICKS);
      return;
    }
    boolean nearZero = low > 0 && (low < 0.7 * high || low == high);
    double from = nearZero ? 0 : low;
    double step = FieldPainter.niceStep(Math.max(high - from, 1e-9 + 0.01 * Math.abs(high)), Y_TICKS);
    from = step * Math.floor(from / step);
    setRange(chart.getAxisY(), from, Math.max(step * Math.ceil(high / step), from + step), Y_TICKS);
  }

  private static void setRange(IAxis<?> axis, double from, double to, int ticks) {
    Range range = new Range(from, to);
    if (axis.getRangePolicy() instanceof RangePolicyFixedViewport
        && range.equals(axis.getRangePolicy().getRange())) {
      return;
    }
    axis.setRangePolicy(new RangePolicyFixedViewport(range));
    double step = FieldPainter.niceStep(to - from, ticks);
    axis.setMajorTickSpacing(step);
    axis.setMinorTickSpacing(step);
  }

  void clear() { chart.getTraces().forEach(ITrace2D::removeAllPoints); }

  /** Frees the chart's thread. */
  void close() { chart.destroy(); }
}
